import { expect, test } from "vitest";
import * as round from "./round.js";

test("rounding up gives few digits and is never below; rounding down gives whole micrometres", () => {
  expect([0.0500001, 0.05, 0.07, 0.0655, 11.2631, 137.234, 1234.5].map(round.up)).toEqual([
    0.051, 0.05, 0.07, 0.066, 11.3, 138, 1235,
  ]);
  expect([0.0475, 0.048, 0.057].map(round.micrometreBelow)).toEqual([0.047, 0.048, 0.057]);
});
