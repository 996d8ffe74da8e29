import { expect, test } from "vitest";
import { coverage, factorFor, litPixels, wholeBytes } from "./bitmap.js";
import type { Rectangle } from "./bitmap.js";
import { dragged, fitted, moved, WHOLE, windowOf, zoomed } from "./window.js";
import { bands, densityEnd, zoomHeights, type ChartData } from "./chart.js";
import * as colour from "../../view/legend/palette.js";
import { layerAt } from "../../view/scene/lookup.js";

/** Naive reference for `coverage`, one pixel at a time. */
function naive(bits: Uint8Array, width: number, height: number, part: Rectangle, factor: number): number[] {
  const stride = Math.ceil(width / 8);
  const lit = (x: number, y: number): number =>
    x < width && y < height ? ((bits[y * stride + (x >> 3)] ?? 0) >> (7 - (x & 7))) & 1 : 0;
  const out: number[] = [];
  for (let y = 0; y < part.height; y += factor) {
    for (let x = 0; x < part.width; x += factor) {
      let sum = 0;
      for (let dy = 0; dy < Math.min(factor, part.height - y); dy++) {
        for (let dx = 0; dx < factor; dx++) sum += lit(part.x + x + dx, part.y + y + dy);
      }
      out.push(Math.round((255 * sum) / (factor * factor)));
    }
  }
  return out;
}

const [MASK_WIDTH, MASK_HEIGHT] = [37, 29];
const BITS = Uint8Array.from({ length: Math.ceil(MASK_WIDTH / 8) * MASK_HEIGHT }, (_, i) =>
  // Bits beyond the width are padding, which the format leaves 0.
  i % 5 === 4 ? ((i * 89 + 41) & 0b11111000) : (i * 89 + 41) & 255,
);

test.each([
  [1, { x: 0, y: 0, width: 37, height: 29 }],
  [2, { x: 0, y: 0, width: 37, height: 29 }],
  [4, { x: 0, y: 0, width: 37, height: 29 }],
  [8, { x: 0, y: 0, width: 37, height: 29 }],
  [1, { x: 8, y: 8, width: 16, height: 8 }],
  [4, { x: 16, y: 8, width: 21, height: 21 }],
])("a mask merged by %i is the mean of its blocks: %j", (factor, part) => {
  const got = coverage(BITS, MASK_WIDTH, part, factor);
  expect([got.width, got.height]).toEqual([Math.ceil(part.width / factor), Math.ceil(part.height / factor)]);
  expect([...got.values]).toEqual(naive(BITS, MASK_WIDTH, MASK_HEIGHT, part, factor));
});

test("pixels are merged only while the merged ones are no larger than screen pixels", () => {
  expect([2, 1, 0.6, 0.5, 0.3, 0.25, 0.1, 0.01].map(factorFor)).toEqual([1, 1, 1, 2, 2, 4, 8, 8]);
});

test("wholeBytes() extends a part to whole bytes, within the mask", () => {
  expect(wholeBytes({ x: 9, y: 3, width: 10, height: 6 }, 37, 29)).toEqual({ x: 8, y: 0, width: 16, height: 16 });
  expect(wholeBytes({ x: -4, y: -9, width: 99, height: 99 }, 37, 29)).toEqual({ x: 0, y: 0, width: 37, height: 29 });
});

test("the whole mask fits the screen with its true proportions", () => {
  const { part, scale } = windowOf(WHOLE, [100, 50], [400, 400], 2);
  expect(scale).toEqual([4, 8]);
  expect(part).toEqual({ x: 0, y: 0, width: 100, height: 50 });
});

test("a part in the middle is fitted with some room, in the tighter direction", () => {
  const [mask, screen] = [[1000, 500], [200, 200]] as const;
  const place = fitted([100, 50], mask, screen, 1);
  expect(place.centre).toEqual([0.5, 0.5]);
  const { part } = windowOf(place, mask, screen, 1);
  expect(part.width).toBeCloseTo(115, 6);
  // The whole mask is never made smaller.
  expect(fitted([1000, 500], mask, screen, 1)).toEqual(WHOLE);
});

test("lit pixels are counted", () => expect(litPixels(Uint8Array.of(0xff, 0, 0x81))).toBe(10));

test("zooming keeps the centre, and moving stops at the edges of the mask", () => {
  const twice = zoomed({ zoom: 1, centre: [0.5, 0.5] }, 2);
  expect(windowOf(twice, [100, 100], [100, 100], 1).part).toEqual({ x: 25, y: 25, width: 50, height: 50 });
  const corner = moved(moved(twice, [9, 0]), [0, -9]);
  expect(windowOf(corner, [100, 100], [100, 100], 1).part).toEqual({ x: 50, y: 0, width: 50, height: 50 });
  expect(zoomed(corner, 0.5)).toEqual(WHOLE);
});

test("what two fingers hold stays under them, whatever the proportions, up to the edges of the mask", () => {
  const [mask, screen, pitch] = [[200, 100], [300, 300], 1] as const;
  const at = (place: typeof WHOLE, [x, y]: readonly [number, number]): number[] => {
    const { part } = windowOf(place, mask, screen, pitch);
    return [part.x + x * part.width, part.y + y * part.height];
  };
  const first = dragged(WHOLE, { times: 4, from: [0.4, 0.5], to: [0.4, 0.5] }, mask, screen, pitch);
  expect(first.zoom).toBe(4);
  const [x, y] = at(WHOLE, [0.4, 0.5]);
  expect(at(first, [0.4, 0.5])[0]).toBeCloseTo(x ?? 0);
  expect(at(first, [0.4, 0.5])[1]).toBeCloseTo(y ?? 0);
  const second = dragged(first, { from: [0.5, 0.5], to: [0.55, 0.4] }, mask, screen, pitch);
  const [u = 0, v = 0] = at(first, [0.5, 0.5]);
  expect(at(second, [0.55, 0.4])[0]).toBeCloseTo(u);
  expect(at(second, [0.55, 0.4])[1]).toBeCloseTo(v);
  const far = windowOf(dragged(first, { from: [0, 0], to: [9, 9] }, mask, screen, pitch), mask, screen, pitch).part;
  expect([far.x, far.y]).toEqual([0, 0]);
  expect(dragged(second, { times: 0.1, from: [0, 0], to: [1, 1] }, mask, screen, pitch)).toEqual(WHOLE);
});

test("thin is light, thick is dark, and values outside the scale are clamped", () => {
  const [thin, thick] = [colour.ofThickness(0.05, [0.05, 0.15]), colour.ofThickness(0.15, [0.05, 0.15])];
  expect(Math.min(...thin)).toBeGreaterThan(Math.max(...thick));
  expect(colour.ofThickness(1, [0.05, 0.15])).toEqual(thick);
  expect(colour.ofThickness(0.05, [0.05, 0.05])).toEqual(colour.colourAt(0.5));
});

test("the layer at a height, ends included", () => {
  const z = [0, 0.1, 0.2, 0.4];
  expect([-1, 0, 0.05, 0.1, 0.39, 0.4, 9].map((at) => layerAt(z, at))).toEqual([0, 0, 0, 1, 2, 2, 2]);
});

const data: ChartData = {
  metric: "cusp",
  profile: new Float32Array(40),
  bin_mm: 0.01,
  z_mm: [0, 0.1, 0.2, 0.4],
  thickness_mm: [0.1, 0.1, 0.2],
  off_mm: [],
  limits: [0.1, 0.2],
};

test("rows of the same thickness join into a band, from the top down", () => {
  expect(bands(data, 0.4, 0, 8)).toEqual([
    { row: 0, rows: 4, thickness_mm: 0.2 },
    { row: 4, rows: 4, thickness_mm: 0.1 },
  ]);
});

test("a row across several layers has their mean, and rows outside the model are left out", () => {
  const [only, ...others] = bands(data, 0.8, 0, 2);
  expect(others).toEqual([]);
  expect(only?.row).toBe(1);
  expect(only?.thickness_mm).toBeCloseTo(0.4 / 3);
});

test("the axis ends at the metric's bound, or at the largest area of the model", () => {
  const end = (metric: ChartData["metric"], ...profile: number[]): number =>
    densityEnd({ ...data, metric, profile: Float32Array.from(profile) });
  expect(end("cusp", 0.5)).toBeCloseTo(1, 1);
  expect(end("roughness", 0.5)).toBeCloseTo(2, 1);
  expect(end("area", 0.5)).toBeCloseTo(2, 1);
  expect(end("volume", 0, 300, 200)).toBeCloseTo(303);
  expect(end("volume", 0)).toBe(1);
});

test("heights are zoomed around a point that keeps its place, within the model, down to a least span", () => {
  expect(zoomHeights([0, 20], 2, 10, 0.5, 20, 1)).toEqual([5, 15]);
  expect(zoomHeights([5, 15], 1, 10, 0.25, 20, 1)).toEqual([7.5, 17.5]);
  // Limited by the ends of the model.
  expect(zoomHeights([5, 15], 1, 10, 1, 20, 1)).toEqual([0, 10]);
  expect(zoomHeights([5, 15], 1, 18, 0.5, 20, 1)).toEqual([10, 20]);
  expect(zoomHeights([5, 15], 0.25, 10, 0.5, 20, 1)).toEqual([0, 20]);
  expect(zoomHeights([5, 15], 1000, 10, 0.5, 20, 1)).toEqual([9.5, 10.5]);
});
