/** Rules of the core that forms apply before a worker has started, against what reports say. */
import { beforeAll, expect, test } from "vitest";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { jobOf, planOf, startCore } from "./core.node-fixture.js";
import { FACTS, nozzleLayers, usualOf } from "./facts.js";

beforeAll(startCore);

test("layers and tolerances that forms show are those of plans, for every metric and nozzle", async () => {
  const job = jobOf(binaryStl(exampleTriangles()));
  // The default for volume depends on the model.
  for (const metric of ["cusp", "deviation", "filament-roundness", "roughness", "area"] as const) {
    const report = await planOf(job, { metric, rays: 64, backend: "cpu" });
    expect(report.tolerance, metric).toBe(usualOf(metric, ""));
  }
  for (const format of ["prusa-3mf", "orca-3mf"] as const) {
    for (const nozzle_mm of [undefined, 0.2, 0.25, 0.4, 0.6, 0.8, 1.2]) {
      const nozzle = nozzle_mm === undefined ? {} : { nozzle_mm };
      const report = await planOf(job, { format, rays: 64, backend: "cpu", ...nozzle });
      const layers = nozzleLayers(format, nozzle_mm ?? FACTS.nozzle_mm);
      expect(report.options, `${format} ${nozzle_mm}`).toMatchObject({ ...layers, nozzle_mm: nozzle_mm ?? FACTS.nozzle_mm });
      expect(report.tolerance, `${format} ${nozzle_mm}`).toBe(usualOf("cusp", format, nozzle_mm));
      expect(report.print_file.filament?.first_layer_mm).toBe(layers?.first_layer_mm);
    }
  }
  job.free();
});
