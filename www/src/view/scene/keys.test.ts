import { expect, it } from "vitest";
import { pressed, type Action, type Tool } from "./keys.js";
import { ticks } from "../legend/legend.js";

const press = (key: string, tool: Tool = "turn", held: Partial<Record<"shiftKey" | "ctrlKey" | "metaKey", boolean>> = {}): Action | null =>
  pressed({ key, shiftKey: false, ctrlKey: false, metaKey: false, altKey: false, ...held }, tool);

it("turns the view, or the model with the tool for turning it", () => {
  expect(press("ArrowLeft")).toEqual({ do: "turn-view", right_deg: -10, up_deg: 0 });
  expect(press("ArrowUp", "flat")).toEqual({ do: "turn-view", right_deg: 0, up_deg: 10 });
  expect(press("ArrowLeft", "rotate")).toEqual({ do: "turn-model", axis: "z", degrees: -5 });
  expect(press("ArrowDown", "rotate", { shiftKey: true })).toEqual({ do: "turn-model", axis: "x", degrees: 1 });
  expect(press("PageUp", "rotate")).toEqual({ do: "turn-model", axis: "y", degrees: 5 });
});

it("leaves all other keys to the page", () => {
  for (const key of ["Tab", "Escape", "a", "PageUp", "Home"]) expect(press(key)).toBeNull();
  expect(press("0", "turn", { ctrlKey: true })).toBeNull();
});

it("undoes and redoes strokes while painting, and leaves undo to the page otherwise", () => {
  expect(press("z", "paint", { ctrlKey: true })).toEqual({ do: "undo-stroke" });
  expect(press("Z", "paint", { metaKey: true, shiftKey: true })).toEqual({ do: "redo-stroke" });
  expect(press("y", "paint", { ctrlKey: true })).toEqual({ do: "redo-stroke" });
  expect(press("z", "turn", { ctrlKey: true })).toBeNull();
});

it("puts the ticks of a scale at round thicknesses, clear of its ends", () => {
  expect(ticks([0.03, 0.1])).toEqual([0.06, 0.08]);
  expect(ticks([0.05, 0.15])).toEqual([0.075, 0.1, 0.125]);
  expect(ticks([0.05, 0.05])).toEqual([]);
});

it("moves a copy by the arrow keys and turns it by R, farther with Shift", () => {
  const key = (key: string, shiftKey = false) => pressed({ key, shiftKey, ctrlKey: false, metaKey: false, altKey: false }, "move");
  expect(key("ArrowLeft")).toEqual({ do: "move-copy", x_mm: -1, y_mm: 0, turn_deg: 0 });
  expect(key("ArrowUp", true)).toEqual({ do: "move-copy", x_mm: 0, y_mm: 10, turn_deg: 0 });
  expect(key("r")).toEqual({ do: "move-copy", x_mm: 0, y_mm: 0, turn_deg: 15 });
  expect(key("R", true)).toEqual({ do: "move-copy", x_mm: 0, y_mm: 0, turn_deg: 45 });
  expect(key("PageUp")).toBeNull();
});

it("goes from point to point with a tool that places them, and turns the view with Shift", () => {
  for (const tool of ["supports", "drains"] as const) {
    expect(press("ArrowRight", tool)).toEqual({ do: "next-point", by: 1 });
    expect(press("ArrowDown", tool)).toEqual({ do: "next-point", by: 1 });
    expect(press("ArrowUp", tool)).toEqual({ do: "next-point", by: -1 });
    expect(press("ArrowLeft", tool, { shiftKey: true })).toEqual({ do: "turn-view", right_deg: -10, up_deg: 0 });
    expect(press("Delete", tool)).toEqual({ do: "remove-point" });
    expect(press("Backspace", tool)).toEqual({ do: "remove-point" });
    expect(press("L", tool)).toEqual({ do: "lock-point" });
    expect(press("z", tool, { ctrlKey: true })).toBeNull();
  }
  expect(press("l", "turn")).toBeNull();
});
