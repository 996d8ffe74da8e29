import { expect, test } from "vitest";
import { binaryStl, exampleTriangles } from "./example.js";

const triangles = exampleTriangles();

test("the example stands on the plate, 40 mm high, with some twenty thousand facets", () => {
  const heights = triangles.filter((_, i) => i % 3 === 2);
  expect(heights.reduce((a, b) => Math.min(a, b))).toBe(0);
  expect(heights.reduce((a, b) => Math.max(a, b))).toBe(40);
  expect(triangles.length / 9).toBeGreaterThan(18_000);
  expect(triangles.length / 9).toBeLessThan(32_000);
});

test("the example is closed: every edge occurs once each way, and its ends agree bit for bit", () => {
  const bits = new Uint32Array(triangles.buffer);
  const corner = (facet: number, k: number): string => bits.subarray(9 * facet + 3 * k, 9 * facet + 3 * k + 3).join(",");
  const edges = new Map<string, number>();
  for (let facet = 0; facet < triangles.length / 9; facet++) {
    for (let k = 0; k < 3; k++) {
      const [a, b] = [corner(facet, k), corner(facet, (k + 1) % 3)];
      edges.set(`${a} ${b}`, (edges.get(`${a} ${b}`) ?? 0) + 1);
    }
  }
  const wrong = [...edges].filter(([edge, times]) => {
    const [a, b] = edge.split(" ");
    return a === b || times !== 1 || edges.get(`${b} ${a}`) !== 1;
  });
  expect(edges.size).toBe(triangles.length / 3);
  expect(wrong).toEqual([]);
});

test("the example's facets face outwards", () => {
  let six = 0;
  for (let i = 0; i < triangles.length; i += 9) {
    const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0, cx = 0, cy = 0, cz = 0] = triangles.subarray(i, i + 9);
    six += ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx);
  }
  expect(six / 6).toBeGreaterThan(1000);
});

test("a binary STL holds the number of its facets and their corners", () => {
  const bytes = binaryStl(Float32Array.of(0, 0, 0, 1, 0, 0, 0, 2, 0));
  const view = new DataView(bytes.buffer);
  expect(bytes.length).toBe(134);
  expect(view.getUint32(80, true)).toBe(1);
  expect(view.getFloat32(84 + 12 + 4 * 7, true)).toBe(2);
});
