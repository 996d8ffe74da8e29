/** Tests of the offers for infeasible settings against the core. */
import { beforeAll, expect, test } from "vitest";
import type { Job } from "../../../pkg/cusp_slicer.js";
import { jobOf, planOf, startCore } from "../../api/core.node-fixture.js";
import { ofCore, type SlicerError } from "../../api/error.js";
import type { Report } from "../../api/wire.js";
import { binaryStl } from "../../page/example.js";
import { languageOf } from "../../texts/index.js";
import { ball } from "../../view/fixtures.js";
import { explain } from "./problem.js";
import { changed, check, fromAddress, type Settings } from "./settings.js";

const ENGLISH = languageOf("en");
const HEIGHT_MM = 20;

beforeAll(startCore);

/** Plans a ball as the page does: a report, or the core's error. */
async function planned(job: Job, settings: Settings): Promise<Report | SlicerError> {
  const checked = check(settings);
  if (!checked.ok) throw new Error(JSON.stringify(checked.faults));
  try {
    return await planOf(job, { ...checked.options, rays: 512, backend: "cpu" });
  } catch (error) {
    const known = ofCore(error);
    if (known === null) throw error;
    return known;
  }
}

test.each([
  ["cusp", "metric=cusp&tolerance=0.02"],
  ["deviation", "metric=deviation&tolerance=0.01"],
  ["roughness", "metric=roughness&tolerance=0.06"],
  ["area", "metric=area&tolerance=5"],
  ["volume", "metric=volume&tolerance=0.06"],
  ["cusp over bins of 1 µm", "metric=cusp&tolerance=0.0521&layerMin=0.055"],
  ["cusp in motor steps", "metric=cusp&tolerance=0.04&step=0.0025"],
  ["area in the least time", "metric=area&tolerance=7&minimize=time"],
])("where no plan holds, by %s, either offer leads to one that does", async (_, query) => {
  const job = jobOf(binaryStl(ball(HEIGHT_MM / 2, 96)));
  const settings = fromAddress(query);
  const error = await planned(job, settings);
  if (!("code" in error)) throw new Error("there is a plan");
  const { offers } = explain({ error, task: "plan", name: "ball.stl", settings, height_mm: HEIGHT_MM }, ENGLISH, new Set());
  expect(offers.map(({ label }) => label.replace(/ [\d.]+.*$/, ""))).toEqual(["Tolerance", "Layers from"]);
  for (const { label, change } of offers) {
    const report = await planned(job, changed(settings, change));
    expect("code" in report ? report.code : report.max_error <= report.tolerance, label).toBe(true);
  }
  job.free();
});
