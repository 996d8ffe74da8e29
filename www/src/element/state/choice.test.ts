import { expect, test } from "vitest";
import { choose } from "./choice.js";

test.each([
  [[], []],
  // The core inspects the content and reports what it is.
  [["a.txt", "b.3mf"], ["a.txt"]],
  [["A.STL"], ["A.STL"]],
  [["model"], ["model"]],
  [["notes.txt", "b.stl", "c.stl"], ["b.stl", "c.stl"]],
])("of %j, the STLs are taken", (names, taken) => {
  expect(choose(names.map((name) => ({ name }))).map(({ name }) => name)).toEqual(taken);
});
