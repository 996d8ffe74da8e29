import { expect, test } from "vitest";
import { stlOf } from "./stl.js";

/** The facets of a binary STL, each with its normal, corners and attribute. */
function read(bytes: Uint8Array): { normal: number[]; corners: number[]; attribute: number }[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const count = view.getUint32(80, true);
  expect(bytes).toHaveLength(84 + 50 * count);
  return Array.from({ length: count }, (_, facet) => {
    const numbers = Array.from({ length: 12 }, (_, i) => view.getFloat32(84 + 50 * facet + 4 * i, true));
    return { normal: numbers.slice(0, 3), corners: numbers.slice(3), attribute: view.getUint16(84 + 50 * facet + 48, true) };
  });
}

test("facets are read back as they were, without normals", () => {
  const first = [0, 0, 0, 1.5, 0, 0, 0, -2.25, 3];
  const second = [1e-3, 2, 3, 4, 5, 6, 7, 8, 9].map(Math.fround);
  const bytes = stlOf(Float32Array.of(...first, ...second));
  const [normal, attribute] = [[0, 0, 0], 0];
  expect(read(bytes)).toEqual([{ normal, corners: first, attribute }, { normal, corners: second, attribute }]);
  // A header that begins with `solid` would be taken for text.
  expect([...bytes.subarray(0, 80)]).toEqual(Array<number>(80).fill(0));
});

test("without facets there is a file of none", () => {
  expect(read(stlOf(new Float32Array(0)))).toEqual([]);
});
