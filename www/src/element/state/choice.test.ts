import { expect, test } from "vitest";
import { choose } from "./choice.js";

test.each([
  [[], []],
  // The core inspects the content and reports what it is.
  [["a.txt", "b.step"], ["a.txt"]],
  [["A.STL"], ["A.STL"]],
  [["model"], ["model"]],
  [["notes.txt", "b.stl", "c.3MF", "d.obj"], ["b.stl", "c.3MF", "d.obj"]],
])("of %j, the models are taken", (names, taken) => {
  expect(choose(names.map((name) => ({ name }))).map(({ name }) => name)).toEqual(taken);
});
