import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { defaults, initSync, Slicer } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { DEFAULTS } from "./wire.js";

test("the defaults that forms show match the core's", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  const { tolerance, ...shown } = DEFAULTS;
  expect(defaults()).toMatchObject(shown);
  const slicer = new Slicer(binaryStl(exampleTriangles()));
  // The default for volume depends on the model.
  for (const metric of ["cusp", "deviation", "roughness", "area"] as const) {
    const report = await slicer.plan({ metric, rays: 64, backend: "cpu" }, () => undefined);
    expect(report.tolerance, metric).toBe(tolerance[metric]);
  }
  slicer.free();
});
