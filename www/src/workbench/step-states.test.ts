/** Progress of each step in words. */
import { expect, test } from "vitest";
import type { ModelReport, Verdict } from "../api/wire.js";
import type { Check } from "../api/index.js";
import { report } from "../element/state/report-fixture.js";
import { DEFAULT_SETTINGS, type Faults, type Settings } from "../element/state/settings.js";
import { languageOf, LANGUAGES } from "../texts/index.js";
import { stepStates, type Walked } from "./step-states.js";

const english = languageOf("en");

interface Given {
  settings?: Partial<Settings>;
  faults?: Faults;
  own?: Partial<ModelReport> | null;
  supports?: { strength: "light" | "medium" | "heavy" };
  earlier?: boolean;
  verdict?: Verdict;
}

/** A session with these fields. */
function walked(given: Given = {}): Walked {
  const { settings = {}, faults = {}, supports, earlier = false, verdict } = given;
  const result = given.own === null ? null : { report: report({}), own: given.own, options: { ...(supports && { supports }) } };
  return {
    settings: { ...DEFAULT_SETTINGS, ...settings },
    faults,
    result: result as Walked["result"],
    shown: result === null ? null : ({ layers: result.report.layers } as Walked["shown"]),
    earlier,
    checks: { check: verdict === undefined ? null : ({ verdict } as Check) },
  };
}

const states = (given?: Given): ReturnType<typeof stepStates> => stepStates(walked(given), english);
const point = { at_mm: [0, 0, 0] as [number, number, number] };
const supported = { support_ml: 1, lift_mm: 5, points: [point, point], unreached: [], on_model: 0 };
const fault = { kind: "range", value: 0.1, least: 0.4, most: 50, unit: "mm" } as const;

test("a model as it was dropped has been planned, and nothing else", () => {
  expect(states()).toEqual({
    turn: { words: "As in the file", mark: null },
    check: { words: "Not checked", mark: null },
    hollow: { words: "Solid", mark: null },
    support: { words: "None", mark: null },
    slice: { words: "793 layers", mark: "done" },
  });
  expect(states({ own: null }).slice).toEqual({ words: "–", mark: null });
  expect(states({ settings: { rotation: "0,0,0.7,0.7" } }).turn).toEqual({ words: "Turned", mark: "done" });
});

test("a check is told by its verdict", () => {
  const checked = (verdict: Verdict): unknown => states({ verdict }).check;
  expect(checked("ok")).toEqual({ words: "Nothing found", mark: "done" });
  expect(checked("review")).toEqual({ words: "Worth a look", mark: "look" });
  expect(checked("reject")).toEqual({ words: "Will fail", mark: "wrong" });
  // No tick on a file that will fail.
  expect(states({ verdict: "review" }).slice.mark).toBe("done");
  expect(states({ verdict: "reject" }).slice.mark).toBe("look");
});

test("a hollow model has walls, which may need a look", () => {
  const settings = { wall: "2.5" };
  expect(states({ settings }).hollow).toEqual({ words: "Walls of 2.5\u00a0mm", mark: "done" });
  const warnings: ModelReport["warnings"] = [{ code: "undrained", detail: { basins: 1 } }];
  expect(states({ settings, own: { warnings } }).hollow.mark).toBe("look");
  expect(states({ settings: { wall: "0.1" }, faults: { wall: fault } }).hollow).toEqual({ words: "To be corrected", mark: "wrong" });
});

test("supports are counted once they are planned with their strength", () => {
  const settings = { supports: "medium" } as const;
  const strength = (of: "light" | "medium", unreached = supported.points): unknown =>
    states({ settings, supports: { strength: of }, own: { supported: { ...supported, unreached } } }).support;
  expect(states({ settings }).support).toEqual({ words: "Medium", mark: "done" });
  expect(strength("light", [])).toEqual({ words: "Medium", mark: "done" });
  expect(strength("medium", [])).toEqual({ words: "Medium, 2 points", mark: "done" });
  expect(strength("medium")).toEqual({ words: "Medium, 2 points", mark: "look" });
});

test("supports of the file are said, until others are chosen", () => {
  const own = { supported };
  expect(states({ own }).support).toEqual({ words: "In the file", mark: "done" });
  expect(states({ settings: { supports: "light" }, own }).support.words).toBe("Light");
  // Those of an earlier plan go with the next.
  expect(states({ supports: { strength: "medium" }, own }).support).toEqual({ words: "None", mark: null });
});

test("a plan that is not of the settings on show needs a look, and what is wrong is told where it is", () => {
  expect(states({ earlier: true }).slice.mark).toBe("look");
  const wall = states({ settings: { wall: "0.1" }, faults: { wall: fault }, earlier: true });
  expect([wall.hollow.mark, wall.slice.mark]).toEqual(["wrong", "look"]);
  const lift = states({ settings: { supports: "light" }, faults: { lift: fault }, earlier: true });
  expect([lift.support, lift.slice.mark]).toEqual([{ words: "To be corrected", mark: "wrong" }, "look"]);
  const height = states({ faults: { height: fault } });
  expect([height.hollow.mark, height.slice]).toEqual([null, { words: "To be corrected", mark: "wrong" }]);
});

test("there is nothing to say of what a filament printer's slicer does", () => {
  const { hollow, support } = states({ settings: { format: "prusa-3mf", wall: "2", supports: "heavy" } });
  expect([hollow, support]).toEqual([{ words: "–", mark: null }, { words: "–", mark: null }]);
});

test.each(LANGUAGES)("every state fits its place beside four others: %s", (code) => {
  const language = languageOf(code);
  const all = [
    {},
    { settings: { rotation: "0,0,1,0", wall: "2.5", supports: "medium" }, supports: { strength: "medium" }, own: { supported: { ...supported, points: Array.from({ length: 240 }, () => point) } } },
    { faults: { wall: fault, height: fault } },
  ] satisfies Given[];
  for (const given of all) {
    for (const { words } of Object.values(stepStates(walked(given), language))) expect(words.length).toBeLessThanOrEqual(20);
  }
});
