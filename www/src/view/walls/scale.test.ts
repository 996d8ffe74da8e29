import { expect, test } from "vitest";
import { wallScale } from "./scale.js";

test("the scale ends at ten times the limit, or at 4 mm without one", () => {
  expect(wallScale(0.4)).toEqual({ least_mm: 0.4, full_mm: 4 });
  expect(wallScale(1)).toEqual({ least_mm: 1, full_mm: 10 });
  expect(wallScale(0)).toEqual({ least_mm: 0, full_mm: 4 });
});
