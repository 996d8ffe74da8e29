import { expect, test } from "vitest";
import { jobOf, planOf, startCore } from "../api/core.node-fixture.js";
import { binaryStl, exampleTriangles } from "./example.js";

test("the example shows what adaptive layers are for: by default it saves half of the thin ones, where thick ones step too high", async () => {
  await startCore();
  const job = jobOf(binaryStl(exampleTriangles()));
  const { layers, max_error, tolerance, thickness_mm, uniform } = await planOf(job, { rays: 64, backend: "cpu" });
  expect(max_error).toBeLessThanOrEqual(tolerance);
  expect(layers).toBeLessThan(uniform.finest.layers / 2);
  expect(uniform.coarsest.max_error).toBeGreaterThan(2 * tolerance);
  // Enough thin and thick layers to show both colours and steps.
  const share = (isOne: (mm: number) => boolean): number => thickness_mm.filter(isOne).length / layers;
  expect(share((mm) => mm < 0.09)).toBeGreaterThan(0.25);
  expect(share((mm) => mm > 0.14)).toBeGreaterThan(0.25);
  job.free();
});
