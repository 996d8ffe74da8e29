import { expect, test } from "vitest";
import { History } from "./history.js";

test("steps are undone and redone, and a change clears what was undone", () => {
  const history = new History<number>();
  expect([history.canUndo, history.undo(0)]).toEqual([false, null]);
  history.note(1, "a", 0);
  history.note(2, "b", 0);
  expect(history.undo(3)).toBe(2);
  expect(history.undo(2)).toBe(1);
  expect(history.redo(1)).toBe(2);
  history.note(2, "c", 0);
  expect(history.canRedo).toBe(false);
  expect(history.undo(4)).toBe(2);
});

test("typing without a pause is one step", () => {
  const history = new History<string>();
  history.note("", "height", 0);
  history.note("6", "height", 300);
  history.note("60", "tolerance", 400);
  history.note("60", "tolerance", 5000);
  expect([history.undo("x"), history.undo("x"), history.undo("x")]).toEqual(["60", "60", ""]);
  expect(history.canUndo).toBe(false);
});
