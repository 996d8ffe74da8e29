import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { initSync, later_arrived, OrientationSearch, type Candidate, type SearchOptions } from "../../../pkg/cusp_slicer.js";
import { DEFAULT_AIMS } from "./orientation.js";

test("the initial aims of the panel are the core's defaults", async () => {
  const read = (part: string): Promise<Buffer> => readFile(new URL(`../../../pkg/cusp_slicer_${part}.wasm`, import.meta.url));
  const first = initSync({ module: await read("bg") });
  await WebAssembly.instantiate(await read("later"), { first: { ...first } });
  later_arrived();
  // Any other aims give two candidates with metrics like these different energies.
  const candidates = [1, 2].map((part): Candidate => {
    const metrics = { layers: 10, print_time_s: 10 * part, max_error: 1 / part, roughness_mm: 1 / part ** 2, overhang_mm2: 1 / part ** 3, islands: 0, cups_mm2: 0, support_ml: 0, contact_mm2: 0 };
    return { direction: [0, 0, 1], rotation: [0, 0, 0, 1], size_mm: [1, 1, 1], excluded: null, metrics, energy: null };
  });
  const energies = (search: SearchOptions): unknown => OrientationSearch.of_measured(search, candidates).rated().map((it) => it?.energy);
  expect(energies(DEFAULT_AIMS)).toEqual(energies({}));
  for (const other of [{ alpha: 0.4 }, { cost: "time" }, { quality: "roughness" }, { quality: "overhang" }] as const) {
    expect(energies({ ...DEFAULT_AIMS, ...other })).not.toEqual(energies({}));
  }
});
