import { readFile } from "node:fs/promises";
import { beforeAll, expect, test } from "vitest";
import { initSync, OrientationSearch, type Candidate, type SearchOptions } from "../../../pkg/cusp_slicer.js";
import { packed, unpacked } from "../../api/candidates.js";

beforeAll(async () => {
  initSync({ module: await readFile(new URL("../../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
});

test("candidates come through the core as they are", () => {
  const metrics = { layers: 10, print_time_s: 20, max_error: 0.5, roughness_mm: 0.25, overhang_mm2: 30, islands: 4, cups_mm2: 5, support_ml: 0.5, contact_mm2: 2 };
  const candidate = (changed: Partial<Candidate>): Candidate => ({ direction: [0, 0.6, 0.8], rotation: [0.1, 0.2, 0.3, 0.9], size_mm: [1, 2, 3], excluded: null, metrics, energy: null, ...changed });
  // Exclusion of a direction by its metrics depends on the limits of the search.
  const given = [candidate({}), ...(["too-large", "too-high", "no-plan"] as const).map((excluded) => candidate({ excluded, metrics: null }))];
  const through = (search: SearchOptions): unknown => unpacked(OrientationSearch.of_measured(search, packed(given)).rated());
  expect(through({})).toEqual(given.map((it) => ({ ...it, energy: it.excluded === null ? 1 : null })));
  const limits = { overhang: { most_overhang_mm2: 1 }, islands: { most_islands: 1 }, cups: { most_cups_mm2: 1 } } as const;
  for (const [excluded, limit] of Object.entries(limits)) expect(through(limit)).toEqual(given.map((it) => ({ ...it, excluded: it.excluded ?? excluded })));
});
