import { beforeAll, expect, test } from "vitest";
import { default_limits } from "../../../pkg/cusp_slicer.js";
import { startCore } from "../../api/core.node-fixture.js";
import { WALL_MM, wallScale } from "./scale.js";

beforeAll(startCore);

test("walls are marked from the thickness that the core takes for thin where a shop says nothing", () => {
  expect(WALL_MM).toBe(default_limits().wall_mm);
});

test("the scale ends at ten times the limit, also of a shop without one", () => {
  expect(wallScale(0.4)).toEqual({ least_mm: 0.4, full_mm: 4 });
  expect(wallScale(1)).toEqual({ least_mm: 1, full_mm: 10 });
  expect(wallScale(0)).toEqual({ least_mm: 0, full_mm: 4 });
});
