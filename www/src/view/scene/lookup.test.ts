import { expect, it } from "vitest";
import { layerAt, packBoundaries, ROW, rowsFor } from "./lookup.js";

/** Boundaries of layers whose thickness cycles from 30 to 100 µm. */
function plan(layers: number): number[] {
  const out = [0];
  for (let layer = 0; layer < layers; layer++) out.push((out[layer] ?? 0) + 0.03 + 0.01 * (layer % 8));
  return out;
}

/** Linear search, obviously correct. */
function naive(boundaries: readonly number[], z: number): number {
  const found = boundaries.findIndex((bottom, layer) => bottom <= z && z < (boundaries[layer + 1] ?? Infinity));
  return Math.min(Math.max(found, 0), boundaries.length - 2);
}

it.each([1, 2, 3, 1023, 1024, 2000])("finds each of %i layers by its bottom, its middle and just below its top", (layers) => {
  const boundaries = plan(layers);
  for (let layer = 0; layer < layers; layer++) {
    const [bottom = 0, top = 0] = boundaries.slice(layer, layer + 2);
    for (const z of [bottom, (bottom + top) / 2, top - 1e-6]) {
      expect(layerAt(boundaries, z)).toBe(layer);
      expect(naive(boundaries, z)).toBe(layer);
    }
  }
});

it("clamps to the first and the last layer beyond the ends", () => {
  expect(layerAt(plan(5), -1)).toBe(0);
  expect(layerAt(plan(5), 100)).toBe(4);
});

it.each([2, ROW, ROW + 1, 5000])("packs %i boundaries into rows and finds the same layers", (count) => {
  const boundaries = plan(count - 1);
  const packed = new Float32Array(ROW * rowsFor(count));
  packBoundaries(boundaries, packed);
  expect([...packed.subarray(0, count)]).toEqual(boundaries.map(Math.fround));
  expect(packed.at(-1)).toBe(Math.fround(boundaries.at(-1) ?? 0));
  for (let layer = 0; layer < count - 1; layer++) {
    const middle = ((boundaries[layer] ?? 0) + (boundaries[layer + 1] ?? 0)) / 2;
    expect(layerAt(packed.subarray(0, count), middle)).toBe(layer);
  }
});
