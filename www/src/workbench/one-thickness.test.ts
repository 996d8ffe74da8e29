import { expect, test } from "vitest";
import type { Warning } from "../api/wire.js";
import { DEFAULT_SETTINGS, type Settings } from "../element/state/settings.js";
import { isOf, oneThickness } from "./one-thickness.js";

const settings: Settings = { ...DEFAULT_SETTINGS, printer: "sl1s" };

function found(best: { layer_mm: number; layers: number } | null, fixed: (keyof Settings)[] = []): ReturnType<typeof oneThickness> {
  const warnings: Warning[] = [{ code: "one-thickness", detail: { taker: "Prusa SL1S SPEED", best } }];
  const session = { result: { report: { layers: 515, warnings } }, settings, fixed: new Set(fixed) };
  return oneThickness(session as unknown as Parameters<typeof oneThickness>[0]);
}

test("a printer of one thickness gets the best uniform layers", () => {
  const best = { layer_mm: 0.06500000000000002, layers: 615 };
  expect(found(best)).toEqual({
    change: { planner: "uniform", uniform: "0.065" },
    replaced: { taker: "Prusa SL1S SPEED", layers: 515, of: { printer: "sl1s", format: "" } },
  });
  expect(found(null)).toBeNull();
  expect(found(best, ["planner"])).toBeNull();
});

test("a plan that gave way is that of one printer and one format", () => {
  const replaced = found({ layer_mm: 0.05, layers: 800 })?.replaced;
  if (replaced === undefined) throw new Error("nothing gave way");
  expect(isOf(replaced, settings)).toBe(true);
  expect(isOf(replaced, { ...settings, printer: "mars-4-ultra" })).toBe(false);
  expect(isOf(replaced, { ...settings, format: "goo" })).toBe(false);
});
