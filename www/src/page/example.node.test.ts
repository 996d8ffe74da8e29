import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { initSync, Slicer } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "./example.js";

test("the example shows what adaptive layers are for: by default it saves half of the thin ones, where thick ones step too high", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  const slicer = new Slicer(binaryStl(exampleTriangles()), {});
  const { layers, max_error, tolerance, thickness_mm, uniform } = await slicer.plan({ rays: 64, backend: "cpu" }, () => undefined);
  expect(max_error).toBeLessThanOrEqual(tolerance);
  expect(layers).toBeLessThan(uniform.finest.layers / 2);
  expect(uniform.coarsest.max_error).toBeGreaterThan(2 * tolerance);
  // Thin ones and thick ones, each in good number: colours to see, and steps.
  const share = (isOne: (mm: number) => boolean): number => thickness_mm.filter(isOne).length / layers;
  expect(share((mm) => mm < 0.09)).toBeGreaterThan(0.25);
  expect(share((mm) => mm > 0.14)).toBeGreaterThan(0.25);
  slicer.free();
});
