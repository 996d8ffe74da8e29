import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { defaults, initSync, rate_candidates, Slicer, type Candidate } from "../../pkg/cusp_slicer.js";
import { binaryStl, exampleTriangles } from "../page/example.js";
import { DEFAULT_SEARCH, DEFAULTS } from "./wire.js";

test("the defaults that forms show are the core's", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  const { tolerance, ...shown } = DEFAULTS;
  expect(defaults()).toMatchObject(shown);
  const slicer = new Slicer(binaryStl(exampleTriangles()));
  // What volume takes depends on the model.
  for (const metric of ["cusp", "roughness", "area"] as const) {
    const report = await slicer.plan({ metric, rays: 64, backend: "cpu" }, () => undefined);
    expect(report.tolerance, metric).toBe(tolerance[metric]);
  }
  slicer.free();
});

test("a search for directions judges them as the core does by itself", async () => {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
  // Of two candidates with metrics like these, no other aims have the same energies.
  const candidates = [1, 2].map((part): Candidate => {
    const metrics = { layers: 10, print_time_s: 10 * part, max_error: 1 / part, roughness_mm: 1 / part ** 2, overhang_mm2: 1 / part ** 3 };
    return { direction: [0, 0, 1], rotation: [0, 0, 0, 1], size_mm: [1, 1, 1], excluded: null, metrics, energy: null };
  });
  const { energies } = rate_candidates(candidates, {});
  const { alpha, cost, quality } = DEFAULT_SEARCH;
  expect(rate_candidates(candidates, { alpha, cost, quality }).energies).toEqual(energies);
  for (const other of [{ alpha: 0.4 }, { cost: "time" }, { quality: "roughness" }, { quality: "overhang" }] as const) {
    expect(rate_candidates(candidates, { alpha, cost, quality, ...other }).energies).not.toEqual(energies);
  }
});
