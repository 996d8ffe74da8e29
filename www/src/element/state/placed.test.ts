import { expect, test } from "vitest";
import { placedFrom, placedText, type Placed } from "./placed.js";

const contact: Placed = { at_mm: [1.5, -2, 3.25], inward: null, diameter_mm: null, isLocked: true };
const wide: Placed = { at_mm: [0, 0, 0.001], inward: null, diameter_mm: 0.8, isLocked: false };
const hole: Placed = { at_mm: [1, 2, 3], inward: [0, 0.6, -0.8], diameter_mm: 3, isLocked: true };

test("points are a text, and the same points again", () => {
  expect(placedText([contact, wide])).toBe("1.5,-2,3.25,,1;0,0,0.001,0.8,0");
  expect(placedFrom(placedText([contact, wide]), "points")).toEqual([contact, wide]);
  expect(placedText([hole])).toBe("1,2,3,0,0.6,-0.8,3,1");
  expect(placedFrom(placedText([hole]), "drains")).toEqual([hole]);
  expect(placedFrom("", "points")).toEqual([]);
  expect(placedText([])).toBe("");
});

test("a text has whole micrometres, and no negative zero", () => {
  expect(placedText([{ ...contact, at_mm: [0.00049, -0.0001, 12.34567] }])).toBe("0,0,12.346,,1");
});

test.each(["1,2,3", "1,2,3,,2", "1,2,,,1", "1,2,x,,1", "1,2,3,0.05,1", "1,2,3,99,0", "1,2,3,,1;", "1,2,1e999,,1", "1,2,3,,1,4"])("%s are no points", (text) => {
  expect(placedFrom(text, "points")).toBeNull();
});

test.each(["1,2,3,,1", "1,2,3,0,0,0,3,1", "1,2,3,0,0,1,,1", "1,2,3,0,0,NaN,3,0"])("%s are no holes", (text) => {
  expect(placedFrom(text, "drains")).toBeNull();
});
