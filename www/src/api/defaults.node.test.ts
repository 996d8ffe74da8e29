import { beforeAll, expect, test } from "vitest";
import { default_arranging, defaults } from "../../pkg/cusp_slicer.js";
import { CONTACT_MM, DRAIN_MM } from "../element/state/hand-points.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { jobOf, planOf, startCore } from "./core.node-fixture.js";
import { DEFAULTS, nozzleLayers, usualOf, type Options, type Report } from "./wire.js";

beforeAll(startCore);

test("the defaults that forms show match the core's", async () => {
  const { tolerance, arranging, nozzle_mm: usual_mm, ...shown } = DEFAULTS;
  expect(defaults()).toMatchObject(shown);
  expect(default_arranging()).toEqual(arranging);
  const job = jobOf(binaryStl(exampleTriangles()));
  // The default for volume depends on the model.
  for (const metric of ["cusp", "deviation", "thread", "roughness", "area"] as const) {
    const report = await planOf(job, { metric, rays: 64, backend: "cpu" });
    expect(report.tolerance, metric).toBe(tolerance[metric]);
  }
  for (const format of ["prusa-3mf", "orca-3mf"] as const) {
    for (const nozzle_mm of [undefined, 0.2, 0.25, 0.4, 0.6, 0.8, 1.2]) {
      const nozzle = nozzle_mm === undefined ? {} : { nozzle_mm };
      const report = await planOf(job, { format, rays: 64, backend: "cpu", ...nozzle });
      const layers = nozzleLayers(format, nozzle_mm ?? usual_mm);
      expect(report.options, `${format} ${nozzle_mm}`).toMatchObject({ ...layers, nozzle_mm: nozzle_mm ?? usual_mm });
      expect(report.tolerance, `${format} ${nozzle_mm}`).toBe(usualOf("cusp", format, nozzle_mm));
      expect(report.print_file.filament?.first_layer_mm).toBe(layers.first_layer_mm);
    }
  }
  job.free();
});

test("the diameters of contacts and drain holes that forms show match the core's", async () => {
  const job = jobOf(binaryStl(exampleTriangles()));
  const plan = (options: Options): Promise<Report> => planOf(job, { rays: 64, backend: "cpu", ...options });
  for (const strength of ["light", "medium", "heavy"] as const) {
    const { models: [{ supported } = {}] } = await plan({ supports: { strength } });
    const { at_mm } = supported?.points[0] ?? {};
    if (at_mm === undefined) throw new Error("the model has no supports");
    // A report has only diameters that are not those of the strength.
    for (const [contact_mm, said] of [[CONTACT_MM[strength], undefined], [0.55, 0.55]] as const) {
      const again = await plan({ supports: { strength, points: [{ at_mm, contact_mm }] } });
      expect(again.models[0]?.supported?.points[0]?.contact_mm, strength).toBe(said);
    }
  }
  const { options } = await plan({ hollow: { auto_drain: {} } });
  expect(options.hollow?.auto_drain?.diameter_mm).toBe(DRAIN_MM);
  job.free();
});
