import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { default_arranging, defaults, initSync, Slicer } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { DEFAULTS, nozzleLayers, usualOf } from "./wire.js";

test("the defaults that forms show match the core's", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  const { tolerance, arranging, nozzle_mm: usual_mm, ...shown } = DEFAULTS;
  expect(defaults()).toMatchObject(shown);
  expect(default_arranging()).toEqual(arranging);
  const slicer = new Slicer(binaryStl(exampleTriangles()));
  // The default for volume depends on the model.
  for (const metric of ["cusp", "deviation", "thread", "roughness", "area"] as const) {
    const report = await slicer.plan({ metric, rays: 64, backend: "cpu" }, () => undefined);
    expect(report.tolerance, metric).toBe(tolerance[metric]);
  }
  for (const format of ["prusa-3mf", "orca-3mf"] as const) {
    for (const nozzle_mm of [undefined, 0.2, 0.25, 0.4, 0.6, 0.8, 1.2]) {
      const nozzle = nozzle_mm === undefined ? {} : { nozzle_mm };
      const report = await slicer.plan({ format, rays: 64, backend: "cpu", ...nozzle }, () => undefined);
      const layers = nozzleLayers(format, nozzle_mm ?? usual_mm);
      expect(report.options, `${format} ${nozzle_mm}`).toMatchObject({ ...layers, nozzle_mm: nozzle_mm ?? usual_mm });
      expect(report.tolerance, `${format} ${nozzle_mm}`).toBe(usualOf("cusp", format, nozzle_mm));
      expect(report.print_file.filament?.first_layer_mm).toBe(layers.first_layer_mm);
    }
  }
  slicer.free();
});
