import { expect, test } from "vitest";
import type { ModelReport } from "../../api/wire.js";
import { added, automatic, cleared, locked, moved, pointAt, pointsOf, removed, resized, type HandPoints } from "./hand-points.js";
import type { PlacedKind } from "./placed.js";
import { report } from "./report-fixture.js";
import type { Result } from "./result.js";
import { changed, check, DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "./settings.js";

const SUPPORTED = { support_ml: 1, lift_mm: 5, on_model: 0 };
const LOW = { at_mm: [0, 0, 0] as [number, number, number] };
const HIGH = { at_mm: [1, 2, 8.1234] as [number, number, number] };
const LOST = { at_mm: [3, 3, 3] as [number, number, number] };

const optionsOf = (settings: Settings) => {
  const checked = check(settings);
  if (!checked.ok) throw new Error("the settings are invalid");
  return checked.options;
};

/** Points of the settings after a plan with this report. */
function shown(kind: PlacedKind, change: Partial<Settings>, own: Partial<ModelReport> | null, isCurrent = true): HandPoints {
  const settings = { ...DEFAULT_SETTINGS, ...change };
  const options = optionsOf(settings);
  const result = own === null ? null : ({ report: report({}), own, options } as Result);
  return pointsOf(kind, { settings, options, result, isCurrent, isAlone: true });
}

const at = ({ list }: HandPoints): unknown[] => list.map(({ at_mm }) => at_mm);

const TO = { at_mm: [5, 5, 5], inward: [0, 0, 1] } as const;

test("as long as nobody places any, points are those of the plan, to the micrometre", () => {
  const points = shown("points", { supports: "light" }, { supported: { ...SUPPORTED, points: [HIGH, LOW], unreached: [LOST] } });
  expect(at(points)).toEqual([[1, 2, 8.123], [0, 0, 0], [3, 3, 3]]);
  expect(points.list.map(({ isUnreached }) => isUnreached)).toEqual([false, false, true]);
  expect(points.list.some(({ isLocked }) => isLocked)).toBe(false);
  expect(at(shown("points", { supports: "none", points: "1,1,1,,1" }, {}))).toEqual([]);
});

test("the first edit takes all points of the plan, and what was added or moved is locked", () => {
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "light" };
  const points = shown("points", settings, { supported: { ...SUPPORTED, points: [HIGH, LOW], unreached: [] } });
  expect(added(points, pointAt("points", TO, null), settings)).toEqual({ points: "1,2,8.123,,0;0,0,0,,0;5,5,5,,1", fill: "off", supports: "light" });
  expect(moved(points, 1, TO, settings)).toMatchObject({ points: "1,2,8.123,,0;5,5,5,,1", fill: "off" });
  expect(resized(points, 1, 0.8, settings)).toMatchObject({ points: "1,2,8.123,,0;0,0,0,0.8,1" });
  expect(locked(points, 0, settings)).toMatchObject({ points: "1,2,8.123,,1;0,0,0,,0" });
  expect(removed(points, 0, settings)).toMatchObject({ points: "0,0,0,,0" });
});

test("a point of a model without supports stands alone, and without the last one there are no supports", () => {
  const points = shown("points", {}, {});
  const change = added(points, pointAt("points", TO, null), DEFAULT_SETTINGS);
  expect(change).toEqual({ points: "5,5,5,,1", fill: "off", supports: "medium" });
  const alone = shown("points", change, { supported: { ...SUPPORTED, points: [{ at_mm: [5, 5, 5] }], unreached: [] } });
  expect(removed(alone, 0, { ...DEFAULT_SETTINGS, ...change })).toEqual(cleared("points", true));
});

test("one of several models without its last point has none, while others keep the setting for supports and holes", () => {
  const own = { supported: { ...SUPPORTED, points: [{ at_mm: TO.at_mm }], unreached: [] } } as unknown as Partial<ModelReport>;
  const points = { ...shown("points", { supports: "light", points: "5,5,5,,1" }, own), isAlone: false };
  const change = removed(points, 0, { ...DEFAULT_SETTINGS, supports: "light" });
  expect(change).toEqual({ points: "none", fill: "off" });
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "light", wall: "2", ...change };
  expect(optionsOf(settings).supports).toBeUndefined();
  expect(shown("points", settings, {}).list).toEqual([]);
  expect(fromAddress(toAddress(settings))).toEqual(settings);
  expect(cleared("drains", false)).toEqual({ drains: "none", drain: "none" });
  expect(optionsOf({ ...settings, ...cleared("drains", false) }).hollow).toEqual({ wall_mm: 2 });
});

test("while the automatic points are unknown, an edit leaves them automatic", () => {
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "light" };
  const points = shown("points", settings, null);
  expect(added(points, pointAt("points", TO, null), settings)).toMatchObject({ points: "5,5,5,,1", fill: "on" });
});

test("points of a plan in another pose are not those of the model", () => {
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "light" };
  const result = { report: report({}), own: { supported: { ...SUPPORTED, points: [LOW], unreached: [] } }, options: { ...optionsOf(settings), height_mm: 7 } } as unknown as Result;
  expect(pointsOf("points", { settings, options: optionsOf(settings), result, isCurrent: false, isAlone: true })).toMatchObject({ list: [], isWhole: false });
});

test("placed automatically, the locked ones stay, and others fill in", () => {
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "heavy", points: "1,1,1,,1;2,2,2,,0" };
  const points = shown("points", settings, { supported: { ...SUPPORTED, points: [{ at_mm: [2, 2, 2] }, { at_mm: [1, 1, 1] }], unreached: [] } });
  const change = automatic(points, settings);
  expect(change).toEqual({ points: "1,1,1,,1", fill: "on", supports: "heavy" });
  const filled = shown("points", { ...settings, ...change }, { supported: { ...SUPPORTED, points: [HIGH, { at_mm: [1, 1, 1.001] }], unreached: [] } });
  expect(at(filled)).toEqual([[1, 1, 1], [1, 2, 8.123]]);
  expect(filled.list.map(({ isLocked }) => isLocked)).toEqual([true, false]);
  expect(automatic(shown("points", { ...settings, points: "2,2,2,,0" }, null), settings)).toMatchObject({ points: "", fill: "off" });
});

test("a point by hand is unreached once a plan of it says so", () => {
  const settings = { supports: "light", points: "1,1,1,,1;2,2,2,,1" } as const;
  const patch = { supported: { ...SUPPORTED, points: [{ at_mm: [1, 1, 1] as [number, number, number] }], unreached: [{ at_mm: [2, 2, 2] as [number, number, number] }] } };
  expect(shown("points", settings, patch).list.map(({ isUnreached }) => isUnreached)).toEqual([false, true]);
  expect(shown("points", settings, patch, false).list.map(({ isUnreached }) => isUnreached)).toEqual([false, false]);
});

test("holes are taken, added and placed anew likewise, in the direction that they go", () => {
  const hollow = { wall: "2" };
  const hollowed = { void_ml: 1, pillars: 0, resolution_mm: 0.2, drains: [{ at_mm: [1, 0, 0] as [number, number, number], direction: [-1, 0, 0] as [number, number, number], diameter_mm: 3, depth_mm: 2 }] };
  const settings = { ...DEFAULT_SETTINGS, ...hollow };
  const points = shown("drains", hollow, { hollowed });
  expect(points.list).toMatchObject([{ at_mm: [1, 0, 0], inward: [-1, 0, 0], diameter_mm: 3, isLocked: false }]);
  const change = added(points, pointAt("drains", TO, 2.5), settings);
  expect(change).toEqual({ drains: "1,0,0,-1,0,0,3,0;5,5,5,0,0,1,2.5,1", drain: "none" });
  const edited = shown("drains", { ...hollow, ...change }, { hollowed });
  // The second hole meets no void.
  expect(edited.list.map(({ isUnreached }) => isUnreached)).toEqual([false, true]);
  expect(automatic(edited, { ...settings, ...change })).toEqual({ drains: "5,5,5,0,0,1,2.5,1", drain: "auto" });
  expect(removed(shown("drains", { ...hollow, ...change, drains: "5,5,5,0,0,1,2.5,1" }, { hollowed }), 0, settings)).toEqual({ drains: "", drain: "none" });
});

test("as options, points are what they are in the address", () => {
  const query = "supports=light&fill=on&protect=on&drain=none&wall=2&points=1%2C2%2C3%2C0.8%2C1%3B4%2C5%2C6%2C%2C0&drains=1%2C2%2C3%2C0%2C0%2C1%2C3%2C1";
  const settings = fromAddress(query);
  expect(toAddress(settings)).toBe(query);
  expect(optionsOf(settings)).toMatchObject({
    supports: { strength: "light", points: [{ at_mm: [1, 2, 3], contact_mm: 0.8 }, { at_mm: [4, 5, 6] }], fill: true, protect: true },
    hollow: { wall_mm: 2, drains: [{ at_mm: [1, 2, 3], direction: [0, 0, 1], diameter_mm: 3 }] },
  });
  expect(optionsOf(settings).hollow).not.toHaveProperty("auto_drain");
  expect(fromAddress("supports=light&points=1,2&drains=x")).toMatchObject({ points: "", drains: "" });
});

test("very many points are left out of the address", () => {
  const points = Array.from({ length: 200 }, (_, i) => `${i},0,0,,1`).join(";");
  expect(toAddress({ ...DEFAULT_SETTINGS, supports: "light", points })).toBe("supports=light");
});

test("another pose has no points by hand, and its own automatic ones", () => {
  const settings: Settings = { ...DEFAULT_SETTINGS, supports: "light", points: "1,1,1,,1", fill: "on", drains: "1,2,3,0,0,1,3,1", drain: "none" };
  const automatic = { points: "", fill: "off", drains: "", drain: "auto" };
  expect(changed(settings, { rotation: "0,0,1,0" })).toMatchObject({ ...automatic, rotation: "0,0,1,0" });
  expect(changed(settings, { height: "20" })).toMatchObject(automatic);
  expect(changed(settings, { unit: "inch" })).toMatchObject(automatic);
  expect(changed(settings, { rotation: "", supports: "heavy" })).toEqual({ ...settings, supports: "heavy" });
  // Without drain holes by hand, their setting stays.
  expect(changed({ ...DEFAULT_SETTINGS, drain: "none" }, { height: "20" }).drain).toBe("none");
});
