import { expect, test } from "vitest";
import { ring } from "./ring.js";

test("a ring is closed: each edge is passed once in either direction", () => {
  const parts = 6;
  const numbers = ring(parts);
  expect(numbers.length).toBe(9 * 2 * parts ** 2);
  const corner = (k: number): string => [...numbers.subarray(3 * k, 3 * k + 3)].map((mm) => mm.toFixed(4)).join().replaceAll("-0.0000", "0.0000");
  const edges = new Map<string, number>();
  for (let k = 0; k < numbers.length / 3; k++) {
    const [from, to] = [corner(k), corner(k % 3 === 2 ? k - 2 : k + 1)];
    edges.set(`${from} ${to}`, (edges.get(`${from} ${to}`) ?? 0) + 1);
    edges.set(`${to} ${from}`, (edges.get(`${to} ${from}`) ?? 0) - 1);
  }
  expect(edges.size).toBe(2 * 3 * parts ** 2);
  expect([...edges.values()].every((sum) => sum === 0)).toBe(true);
});
