import { expect, it } from "vitest";
import { CELLS, layerAt, packBoundaries, ROW, rowsFor } from "./lookup.js";

/** Boundaries of layers whose thickness cycles from 30 to 100 µm. */
function plan(layers: number): number[] {
  const out = [0];
  for (let layer = 0; layer < layers; layer++) out.push((out[layer] ?? 0) + 0.03 + 0.01 * (layer % 8));
  return out;
}

/** Naive linear search. */
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

/** `layerAt` as in the shader, on the texture. Also returns the number of steps. */
function shaded(texture: Float32Array, layers: number, cellsPerMm: number, z: number): [layer: number, steps: number] {
  const cell = Math.min(Math.max(Math.trunc(Math.fround(Math.fround(z) * Math.fround(cellsPerMm))), 0), CELLS * layers - 1);
  const first = texture[layers + 1 + cell] ?? NaN;
  let layer = first;
  while (layer < layers - 1 && (texture[layer + 1] ?? NaN) <= Math.fround(z)) layer++;
  return [layer, layer - first];
}

it.each([1, ROW - 1, ROW, 5000, 100_000])("packs %i layers into rows, in which the shader finds each in few steps", (layers) => {
  const boundaries = plan(layers);
  const packed = new Float32Array(ROW * rowsFor(boundaries.length));
  const cellsPerMm = packBoundaries(boundaries, packed);
  const single = boundaries.map(Math.fround);
  expect([...packed.subarray(0, layers + 1)]).toEqual(single);
  const step = Math.ceil(layers / 5000);
  for (let layer = 0; layer < layers; layer += step) {
    const [bottom = 0, top = 0] = single.slice(layer, layer + 2);
    for (const z of [bottom, (bottom + top) / 2, top - 1e-3]) {
      const [found, steps] = shaded(packed, layers, cellsPerMm, z);
      expect(found).toBe(layer);
      expect(steps).toBeLessThanOrEqual(3);
    }
  }
  expect(shaded(packed, layers, cellsPerMm, -1)[0]).toBe(0);
  expect(shaded(packed, layers, cellsPerMm, 1e6)[0]).toBe(layers - 1);
});
