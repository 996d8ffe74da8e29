import { expect, test } from "vitest";
import { SlicerError, type Slicer } from "../../api/index.js";
import type { Entry } from "./plate.js";
import { Sync } from "./sync.js";

test("weights that were not set are set with the next plan", async () => {
  const asked: unknown[] = [];
  let refusal: Error | null = new SlicerError("bad-options", "cancelled", { system: "" });
  const slicer = {
    update: async () => undefined,
    setWeights: async (weights: Float32Array | null) => {
      asked.push(weights);
      if (refusal !== null) throw refusal;
    },
  } as unknown as Slicer;
  const weights = Float32Array.of(1);
  const entry = { key: 1, copies: 1, rotation: null, height_mm: null, weights, model: { id: 7 } } as unknown as Entry;
  const sync = new Sync(slicer);
  sync.note(entry, true);
  await expect(sync.bring([entry], {})).rejects.toBe(refusal);
  refusal = null;
  await sync.bring([entry], {});
  expect(asked).toEqual([weights, weights]);
  expect(sync.bring([entry], {})).toBeNull();
});
