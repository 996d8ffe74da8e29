import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { defaults, initSync, Slicer } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { DEFAULTS, usualOf } from "./wire.js";

test("the defaults that forms show match the core's", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  const { tolerance, filament, ...shown } = DEFAULTS;
  expect(defaults()).toMatchObject(shown);
  const slicer = new Slicer(binaryStl(exampleTriangles()));
  // The default for volume depends on the model.
  for (const metric of ["cusp", "deviation", "thread", "roughness", "area"] as const) {
    const report = await slicer.plan({ metric, rays: 64, backend: "cpu" }, () => undefined);
    expect(report.tolerance, metric).toBe(tolerance[metric]);
  }
  for (const format of ["prusa-3mf", "orca-3mf"] as const) {
    const report = await slicer.plan({ format, rays: 64, backend: "cpu" }, () => undefined);
    expect(report.options, format).toMatchObject(filament[format]);
    expect(report.tolerance, format).toBe(usualOf("cusp", format));
    expect(report.print_file.filament?.first_layer_mm).toBe(filament[format].first_layer_mm);
  }
  slicer.free();
});
