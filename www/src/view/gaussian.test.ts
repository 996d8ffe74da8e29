import { expect, test } from "vitest";
import { drawSphere, Nearest, placeOf, seenAt, type Side } from "./gaussian.js";
import type { Rgb } from "./legend/palette.js";
import { extentOf, layFlat, sizeOf, turned, UPRIGHT, type Triple } from "./scene/pose.js";
import { back, combined, heightOf, lookFrom, turn, unit } from "./scene/turn.js";

/** Points of a spiral over the sphere. */
function spiral(count: number): Float64Array {
  const out = new Float64Array(3 * count);
  for (let i = 0; i < count; i++) {
    const z = 1 - (2 * i + 1) / count;
    const around = i * Math.PI * (3 - Math.sqrt(5));
    out.set([Math.sqrt(1 - z * z) * Math.cos(around), Math.sqrt(1 - z * z) * Math.sin(around), z], 3 * i);
  }
  return out;
}

const axes = Float64Array.from([1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1]);

function close(found: Triple, wanted: Triple): void {
  for (const [i, part] of found.entries()) expect(part).toBeCloseTo(wanted[i] ?? Number.NaN, 12);
}

test("vectors turn as in the view", () => {
  const a = turned(UPRIGHT, "x", 30);
  const b = turned(UPRIGHT, "z", -70);
  close(turn(combined(a, b), [1, 2, 3]), turn(b, turn(a, [1, 2, 3])));
  close(turn(back(a), turn(a, [1, 2, 3])), [1, 2, 3]);
  close(turn(layFlat(UPRIGHT, [1, 0, 0]), [1, 0, 0]), [0, 0, -1]);
});

test("a turned model is as high as in the view", () => {
  const points = Float32Array.from({ length: 90 }, (_, i) => Math.sin(7 * i));
  const rotation = turned(turned(UPRIGHT, "x", 30), "y", 50);
  expect(heightOf(points, rotation)).toBeCloseTo(sizeOf(extentOf(points, rotation, 1))[2], 12);
  expect(heightOf(new Float32Array(0), rotation)).toBe(0);
});

test("a camera's backward axis is the direction that it looks from, and z is upwards", () => {
  const from = unit([0.55, -1, 0.5]);
  const camera = lookFrom(from);
  close(turn(camera, [0, 0, 1]), from);
  const [, up, towards] = turn(back(camera), [0, 0, 1]);
  expect(up).toBeGreaterThan(0.5);
  expect(towards).toBeGreaterThan(0);
  const [right] = turn(back(camera), [0, 0, 1]);
  expect(right).toBeCloseTo(0, 12);
});

test.each([1, 2, 7, 1000])("the nearest of %i directions is the one that a search of all finds", (count) => {
  const directions = spiral(count);
  const nearest = new Nearest(directions);
  const others = spiral(601);
  for (const [x, y, z] of Array.from({ length: 601 }, (_, i) => others.subarray(3 * i, 3 * i + 3))) {
    const dots = Array.from({ length: count }, (_, i) => {
      const [a = 0, b = 0, c = 0] = directions.subarray(3 * i, 3 * i + 3);
      return a * (x ?? 0) + b * (y ?? 0) + c * (z ?? 0);
    });
    expect(dots[nearest.at(x ?? 0, y ?? 0, z ?? 0)]).toBeCloseTo(Math.max(...dots), 12);
  }
});

test("the direction seen at a place is placed there, on both sides", () => {
  for (const side of ["front", "back"] as const) {
    const seen = seenAt([0.3, -0.4], side);
    if (seen === null) throw new Error("that place is on the sphere");
    const { side: found, place } = placeOf(seen);
    expect(found).toBe(side);
    expect(place[0]).toBeCloseTo(0.3, 12);
    expect(place[1]).toBeCloseTo(-0.4, 12);
  }
  expect(seenAt([0.8, 0.8], "front")).toBeNull();
});

test("front and back show each direction's colour in its place, and nothing outside the disc", () => {
  const colours: (Rgb | null)[] = [[200, 0, 0], [0, 200, 0], null, [0, 0, 200], [200, 200, 0], [0, 200, 200]];
  const side_px = 41;
  const picture = (side: Side): ((right: number, up: number) => number[]) => {
    const pixels = new Uint8ClampedArray(4 * side_px * side_px);
    drawSphere(pixels, side_px, side, back(lookFrom([0, -1, 0])), new Nearest(axes), colours);
    return (right, up) => {
      const [column, row] = [Math.floor(((right + 1) / 2) * side_px), Math.floor(((1 - up) / 2) * side_px)];
      return [...pixels.subarray(4 * (row * side_px + column), 4 * (row * side_px + column) + 4)];
    };
  };
  const front = picture("front");
  const behind = picture("back");
  // In the front view, +x is right, +z up, and -y towards the viewer.
  expect(front(0, 0)).toEqual([0, 0, 200, 255]);
  expect(front(0.9, 0)[0]).toBeGreaterThan(150);
  expect(front(0, 0.9).slice(0, 2).every((it) => it > 150)).toBe(true);
  // In the rear view, +x is left.
  expect(behind(-0.9, 0)[0]).toBeGreaterThan(150);
  expect(behind(0.9, 0)[1]).toBeGreaterThan(150);
  expect(behind(0, 0)[3]).toBe(0);
  expect(front(-0.98, 0.98)[3]).toBe(0);
});
