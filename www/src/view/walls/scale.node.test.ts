import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { WALL_MM, wallScale } from "./scale.js";

test("walls are marked from the thickness that the core takes for thin where a shop says nothing", async () => {
  const source = await readFile(new URL("../../../../docs/schemas/limits.schema.json", import.meta.url), "utf8");
  const schema = JSON.parse(source) as { properties: { wall_mm: { default: number } } };
  expect(WALL_MM).toBe(schema.properties.wall_mm.default);
});

test("the scale ends at ten times the limit, also of a shop without one", () => {
  expect(wallScale(0.4)).toEqual({ least_mm: 0.4, full_mm: 4 });
  expect(wallScale(1)).toEqual({ least_mm: 1, full_mm: 10 });
  expect(wallScale(0)).toEqual({ least_mm: 0, full_mm: 4 });
});
