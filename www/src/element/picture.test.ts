import { expect, test } from "vitest";
import { coverage, factorFor } from "./bitmap.js";
import { bands, densityEnd, type ChartData } from "./chart.js";
import * as colour from "./colour.js";
import { layerAt } from "./layers.js";

/** What `coverage` must find, one pixel at a time. */
function naive(bits: Uint8Array, width: number, height: number, factor: number): number[] {
  const stride = Math.ceil(width / 8);
  const lit = (x: number, y: number): number =>
    x < width && y < height ? ((bits[y * stride + (x >> 3)] ?? 0) >> (7 - (x & 7))) & 1 : 0;
  const out: number[] = [];
  for (let y = 0; y < height; y += factor) {
    for (let x = 0; x < width; x += factor) {
      let sum = 0;
      for (let dy = 0; dy < factor; dy++) for (let dx = 0; dx < factor; dx++) sum += lit(x + dx, y + dy);
      out.push(Math.round((255 * sum) / (factor * factor)));
    }
  }
  return out;
}

test.each([1, 2, 4, 8])("a mask merged by %i is the mean of its blocks", (factor) => {
  const [width, height] = [21, 13];
  const bits = Uint8Array.from({ length: Math.ceil(width / 8) * height }, (_, i) => (i * 89 + 41) & 255);
  // Bits past the width are padding: the format leaves them dark.
  for (let row = 0; row < height; row++) bits[row * 3 + 2] = (bits[row * 3 + 2] ?? 0) & 0b11111000;
  const got = coverage(bits, width, height, factor);
  expect([got.width, got.height]).toEqual([Math.ceil(width / factor), Math.ceil(height / factor)]);
  expect([...got.values]).toEqual(naive(bits, width, height, factor));
});

test("masks are halved until they fit, eight times smaller at most", () => {
  expect(factorFor(1024, 512, 1024)).toBe(1);
  expect(factorFor(2048, 512, 1024)).toBe(2);
  expect(factorFor(512, 4097, 1024)).toBe(8);
  expect(factorFor(99_999, 1, 1024)).toBe(8);
});

test("thin is red, thick is blue, and what lies outside the scale is clamped", () => {
  const [thin, thick] = [colour.ofThickness(0.05, [0.05, 0.15]), colour.ofThickness(0.15, [0.05, 0.15])];
  expect(thin[0]).toBeGreaterThan(2 * thin[2]);
  expect(thick[2]).toBeGreaterThan(2 * thick[0]);
  expect(colour.ofThickness(1, [0.05, 0.15])).toEqual(thick);
  expect(colour.ofThickness(0.05, [0.05, 0.05])).toEqual(colour.at(0.5));
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
  limits: [0.1, 0.2],
};

test("rows of one thickness join into a band; from the top down", () => {
  expect(bands(data, 0.4, 0, 8)).toEqual([
    { row: 0, rows: 4, thickness_mm: 0.2 },
    { row: 4, rows: 4, thickness_mm: 0.1 },
  ]);
});

test("a row over several layers has their mean, and rows off the model have none", () => {
  const [only, ...others] = bands(data, 0.8, 0, 2);
  expect(others).toEqual([]);
  expect(only?.row).toBe(1);
  expect(only?.thickness_mm).toBeCloseTo(0.4 / 3);
});

test("the axis ends where the metric's densities do, or at the largest area of this model", () => {
  const end = (metric: ChartData["metric"], ...profile: number[]): number =>
    densityEnd({ ...data, metric, profile: Float32Array.from(profile) });
  expect(end("cusp", 0.5)).toBeCloseTo(1, 1);
  expect(end("roughness", 0.5)).toBeCloseTo(2, 1);
  expect(end("area", 0.5)).toBeCloseTo(2, 1);
  expect(end("volume", 0, 300, 200)).toBeCloseTo(303);
  expect(end("volume", 0)).toBe(1);
});
