import { expect, test } from "vitest";
import { stepped, within } from "./nearest.js";

test("the nearest marker comes first, and none is farther away than the pointer reaches", () => {
  const markers = [[10, 10], [14, 10], [40, 10], [10, 21]] as const;
  expect(within([13, 10], markers, 12)).toEqual([1, 0, 3]);
  expect(within([100, 100], markers, 12)).toEqual([]);
});

test("steps go round, from the first or the last where none is selected", () => {
  expect(stepped(null, 1, 3)).toBe(0);
  expect(stepped(null, -1, 3)).toBe(2);
  expect(stepped(2, 1, 3)).toBe(0);
  expect(stepped(0, -1, 3)).toBe(2);
  expect(stepped(7, 1, 3)).toBe(0);
  expect(stepped(null, 1, 0)).toBe(null);
});
