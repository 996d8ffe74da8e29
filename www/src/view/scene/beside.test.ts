import { expect, it } from "vitest";
import { besideOf } from "./beside.js";

const view = { top: 100, bottom: 500 };

it("a plot within the view's height is beside it, and leaves the room above and below", () => {
  expect(besideOf(view, { top: 120, bottom: 450 })).toEqual({ top_px: 20, bottom_px: 50 });
  expect(besideOf(view, { top: 99.5, bottom: 500.5 })).toEqual({ top_px: -0.5, bottom_px: -0.5 });
});

it.each([
  ["above", { top: 0, bottom: 90 }],
  ["below", { top: 510, bottom: 800 }],
  ["taller than the view", { top: 90, bottom: 510 }],
  ["not shown", { top: 0, bottom: 0 }],
  ["without height", { top: 200, bottom: 200 }],
])("a plot that is %s is not", (_, plot) => {
  expect(besideOf(view, plot)).toBeNull();
});
