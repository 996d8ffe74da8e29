import { expect, test } from "vitest";
import { described } from "./printer-form.js";

test("a printer is described once all numbers are there; pixels and their sides make the plate, and square pixels need one side", () => {
  const typed = { width: 4000, depth: 2000, pitch_um: 25 };
  expect(described({}, typed)).toBeNull();
  expect(described({}, { ...typed, height_mm: 150 })).toEqual({ pixels: [4000, 2000], pitch_um: [25, 25], volume_mm: [100, 50, 150] });
  expect(described({ model: "Mine", format: "goo" }, { ...typed, pitch_y_um: 24, height_mm: 150 })).toMatchObject({ model: "Mine", format: "goo", pitch_um: [25, 24], volume_mm: [100, 48, 150] });
});
