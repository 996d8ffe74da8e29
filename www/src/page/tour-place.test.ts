import { expect, test } from "vitest";
import { placeOf } from "./tour-place.js";

const card = { width: 280, height: 160 };
const room = { width: 1280, height: 800 };

test("the card goes beside its target, on the side with room", () => {
  expect(placeOf({ left: 0, top: 60, width: 300, height: 740 }, card, room)).toEqual([312, 350]);
  expect(placeOf({ left: 980, top: 60, width: 300, height: 200 }, card, room)).toEqual([688, 80]);
  expect(placeOf({ left: 20, top: 60, width: 1240, height: 200 }, card, room)).toEqual([500, 272]);
  expect(placeOf({ left: 20, top: 560, width: 1240, height: 200 }, card, room)).toEqual([500, 388]);
});

test("it never leaves the window", () => {
  expect(placeOf({ left: 0, top: 0, width: 300, height: 40 }, card, room)).toEqual([312, 12]);
  expect(placeOf({ left: 0, top: 780, width: 300, height: 400 }, card, room)).toEqual([312, 628]);
  // A target as large as the window leaves no room.
  expect(placeOf({ left: 0, top: 0, width: 1280, height: 800 }, card, room)).toEqual([500, 628]);
});

test("on a phone, and without a target, it is at the bottom", () => {
  expect(placeOf({ left: 0, top: 0, width: 390, height: 300 }, { width: 374, height: 150 }, { width: 390, height: 780 })).toEqual([8, 618]);
  expect(placeOf(null, card, room)).toEqual([500, 628]);
});
