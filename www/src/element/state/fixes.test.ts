import { expect, it } from "vitest";
import { canSupport, fixOf } from "./fixes.js";
import { DEFAULT_SETTINGS, type Settings } from "./settings.js";

/** The remedies for a kind, each taken, until there is none or the model is to be turned. */
function walk(code: Parameters<typeof fixOf>[0], from: Partial<Settings> = {}): string[] {
  let settings: Settings = { ...DEFAULT_SETTINGS, ...from };
  const names: string[] = [];
  for (let i = 0; i < 10; i++) {
    const fix = fixOf(code, settings);
    if (fix === null) return names;
    names.push(fix.name);
    if (fix.change === null) return names;
    settings = { ...settings, ...fix.change };
  }
  throw new Error("the remedies do not end");
}

it("supports what hangs in the air, more strongly each time, and then turns the model", () => {
  for (const code of ["island", "loose-body", "overhang"] as const) expect(walk(code), code).toEqual(["supports", "stronger", "orient"]);
  expect(walk("island", { supports: "light" })).toEqual(["stronger", "stronger", "orient"]);
  expect(walk("small-contact")).toEqual(["supports", "raft", "orient"]);
});

it("adds a support at a place where there are others", () => {
  const holds = (code: Parameters<typeof fixOf>[0], change: Partial<Settings>): boolean => canSupport(code, { ...DEFAULT_SETTINGS, ...change });
  expect((["island", "loose-body", "overhang", "cup", "thin-wall"] as const).filter((code) => holds(code, { supports: "light" }))).toEqual(["island", "loose-body", "overhang"]);
  expect([holds("island", { supports: "none" }), holds("island", { supports: "light", format: "prusa-3mf" })]).toEqual([false, false]);
});

it("drains a void, hollows what pulls too much, and leaves to the user what settings cannot change", () => {
  expect(walk("trap", { wall: "2", drain: "none" })).toEqual(["drain"]);
  expect(walk("trap")).toEqual([]);
  expect(walk("cup", { wall: "2", drain: "none" })).toEqual(["drain", "orient"]);
  expect(walk("peel-area")).toEqual(["hollow", "orient"]);
  expect(walk("thin-wall")).toEqual([]);
});

it("offers nothing for filament printers, whose slicers do it themselves", () => {
  expect(walk("overhang", { format: "orca-3mf" })).toEqual([]);
});
