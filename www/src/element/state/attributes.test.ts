import { beforeEach, expect, test } from "vitest";
import type { SlicerError } from "../../api/error.js";
import { FACTS, FORMATS } from "../../api/facts.js";
import type { KnownPrinter, Printer } from "../../api/wire.js";
import { Attributes, settingsOf } from "./attributes.js";
import { METRICS } from "./metric.js";
import type { SettingName } from "../properties.js";
import type { PlateState } from "./plate.js";
import { Preferences } from "./preferences.js";
import { knownPrinter } from "./printer-fixture.js";
import { DEFAULT_SETTINGS, fromAddress, toAddress } from "./settings.js";

class Wishes extends Preferences {
  protected override preferred(): void {}
  protected override standing(): PlateState {
    return { job: 0, entries: [], selected: 0, arranging: FACTS.arranging, placed: [] };
  }
  protected override stand(): boolean {
    return false;
  }
}

const printer = (name: string, thinnest: number): KnownPrinter => knownPrinter({ name, layer_mm: [thinnest, 0.2] });

let wishes: Wishes;
let attributes: Attributes;
let told: SlicerError[];

beforeEach(() => {
  wishes = new Wishes({ ...DEFAULT_SETTINGS }, null);
  told = [];
  attributes = new Attributes(wishes, (error) => told.push(error));
});

/** The errors reported to the page's developer since the last call. */
function details(): unknown[] {
  attributes.settle();
  return told.splice(0).map(({ code, detail }) => ({ code, ...detail }));
}

test.each([
  ["tolerance", "abc"],
  ["tolerance", "0,05"],
  ["tolerance", Number.NaN],
  ["tolerance", "9"],
  ["tolerance", -0.05],
  ["layer-min", "7"],
  ["layer-min", "0.2"],
  ["layer-max", "thick"],
  ["layer-max", 0.02],
  ["printer", 7],
] as const)("%s of %j is invalid: it is reported, and the last good value stays", (name, said) => {
  for (const [name, good] of [["tolerance", "0.06"], ["layer-min", 0.04], ["layer-max", "0.1"], ["printer", "p"]] as const) {
    attributes.set(name, good);
  }
  expect(details()).toEqual([]);
  const { settings } = wishes;
  attributes.set(name, said);
  expect(details()).toEqual([{ code: "bad-attribute", attribute: name, value: said }]);
  expect(wishes.settings).toEqual(settings);
  expect(wishes.faults).toEqual({});
});

test("the message names the attribute, the value and what was expected", () => {
  for (const [name, said] of [["metric", "cups"], ["tolerance", "abc"], ["layer-min", "7"]] as const) attributes.set(name, said);
  attributes.settle();
  expect(told.map(({ message }) => message)).toEqual([
    `metric="cups" is none of ${Object.keys(METRICS).join(", ")}; the last good value stays`,
    `tolerance="abc" is no number; the last good value stays`,
    `layer-min="7" is not from 0.001 to 1; the last good value stays`,
  ]);
});

test.each([
  ["metric", "cups", Object.keys(METRICS)],
  ["format", "zip", [...FORMATS]],
  ["backend", "auto", ["cpu", "gpu"]],
] as const)("%s must be one of a list, which the error names", (attribute, value, known) => {
  expect(attributes.read(attribute, value)).toBeUndefined();
  expect(details()).toEqual([{ code: "bad-attribute", attribute, value, known }]);
  expect(attributes.read(attribute, known[1])).toBe(known[1]);
});

test("the known ones of several panels apply; if none is known, nothing changes", () => {
  expect(attributes.read("panels", " layers  plan ")).toEqual(["plan", "layers"]);
  expect(details()).toEqual([]);
  expect(attributes.read("panels", "plan foo")).toEqual(["plan"]);
  expect(attributes.read("panels", "foo")).toBeUndefined();
  expect(details()).toMatchObject([{ attribute: "panels", value: "plan foo" }, { attribute: "panels", value: "foo" }]);
});

test.each([
  ["quality", "high"],
  ["quality", 1.5],
  ["locale", "not a locale"],
  ["fixed", "weights"],
] as const)("%s of %j is invalid", (attribute, value) => {
  expect(attributes.read(attribute, value)).toBeUndefined();
  expect(details()).toMatchObject([{ code: "bad-attribute", attribute, value }]);
});

test("an absent or empty attribute means the default, and is not an error", () => {
  for (const [name, value] of [["metric", "area"], ["tolerance", "0.2"], ["layer-min", "0.02"], ["format", "uvj"]] as const) {
    attributes.set(name, value);
  }
  for (const name of ["metric", "tolerance", "layer-min", "format", "printer"] as const) attributes.set(name, null);
  expect(wishes.settings).toEqual({ ...DEFAULT_SETTINGS, tolerances: { cusp: "" } });
  for (const name of ["quality", "backend", "locale", "panels", "fixed"] as const) expect(attributes.read(name, " ")).toBeNull();
  expect(details()).toEqual([]);
});

test.each([[["metric", "tolerance"]], [["tolerance", "metric"]]] as [SettingName[]][])(
  "a tolerance is in the unit of the metric that is set with it, in either order: %j",
  (names) => {
    const said = { metric: "area", tolerance: "0.2" } as Record<SettingName, string>;
    for (const name of names) attributes.set(name, said[name]);
    expect(wishes.settings).toMatchObject({ metric: "area", tolerances: { area: "20" } });
    expect(wishes.settings.tolerances.cusp).toBeUndefined();
    expect(details()).toEqual([]);
  },
);

test.each([[["layer-min", "layer-max"]], [["layer-max", "layer-min"]]] as [SettingName[]][])(
  "a range is checked once both its ends are set, in either order: %j",
  (names) => {
    const set = (least: number, most: number): void => {
      for (const name of names) attributes.set(name, name === "layer-min" ? least : most);
    };
    set(0.2, 0.3);
    expect(details()).toEqual([]);
    set(0.02, 0.04);
    expect(details()).toEqual([]);
    set(0.4, 0.3);
    expect(details()).toMatchObject([{ value: 0.3 }, { value: 0.4 }]);
    expect(wishes.options).toMatchObject({ layer_min_mm: 0.02, layer_max_mm: 0.04 });
  },
);

test("a printer is checked once the list has arrived", () => {
  attributes.set("printer", "saturn");
  expect(details()).toEqual([]);
  wishes.printers = [printer("mars", 0.01), printer("saturn", 0.03)];
  attributes.offered();
  expect(details()).toEqual([]);
  attributes.set("printer", "jupiter");
  expect(details()).toEqual([{ code: "bad-attribute", attribute: "printer", value: "jupiter", known: ["mars", "saturn"] }]);
  expect(wishes.settings.printer).toBe("saturn");
});

test("a long list of known names is in the error, and counted in its message", () => {
  wishes.printers = Array.from({ length: 30 }, (_, i) => printer(`p${i}`, 0.01));
  attributes.set("printer", "q");
  attributes.settle();
  expect(told[0]?.message).toBe(`printer="q" is none of the 30 known ones; the last good value stays`);
  expect(told[0]?.detail).toMatchObject({ known: expect.arrayContaining(["p0", "p29"]) });
});

test("a printer of one's own is described, whatever the list; what is no description is reported", () => {
  const own: Printer = { pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245] };
  wishes.printers = [printer("mars", 0.01)];
  attributes.set("printer", own);
  attributes.offered();
  expect(details()).toEqual([]);
  expect(wishes.settings.printer).toBe(own);
  expect(wishes.options).toMatchObject({ printer: own });
  const wrong = { ...own, pitch_um: 50 };
  attributes.set("printer", wrong);
  attributes.settle();
  expect(told[0]?.message).toMatch(/^printer=\{"pixels":.* is neither a name nor a description with pixels, pitch_um and volume_mm; the last good value stays$/);
  expect(details()).toMatchObject([{ attribute: "printer", value: wrong }]);
  expect(wishes.settings.printer).toBe(own);
});

test("two unknown printers set before the list arrives leave no printer", () => {
  attributes.set("printer", "jupiter");
  attributes.settle();
  attributes.set("printer", "neptune");
  attributes.settle();
  wishes.printers = [printer("mars", 0.01)];
  attributes.offered();
  expect(details()).toMatchObject([{ value: "neptune" }]);
  expect(wishes.settings.printer).toBe("");
});

test("a range outside the printer's is reported once the printer is known; what was typed meanwhile stays", () => {
  attributes.set("printer", "saturn");
  attributes.set("layer-min", "0.02");
  attributes.set("layer-max", "0.5");
  attributes.settle();
  wishes.change({ layerMax: "0.18" });
  wishes.printers = [printer("saturn", 0.03)];
  attributes.offered();
  expect(details()).toMatchObject([{ attribute: "layer-min", value: "0.02" }]);
  expect(wishes.settings).toMatchObject({ printer: "saturn", layerMin: "0.05", layerMax: "0.18" });
});

test("a fault that a customer typed is not reported to the developer", () => {
  attributes.set("layer-min", "0.04");
  attributes.settle();
  wishes.change({ layerMin: "x" });
  attributes.set("layer-max", "0.2");
  expect(details()).toEqual([]);
  expect(wishes.faults).toHaveProperty("layerMin");
});

test("a resin must be one of the page's, once there are any", () => {
  attributes.set("resin", "grey");
  wishes.resins = [{ name: "grey" }, { name: "black" }];
  attributes.offered();
  attributes.set("resin", "gold");
  expect(details()).toMatchObject([{ attribute: "resin", value: "gold", known: ["grey", "black"] }]);
  expect(wishes.settings.resin).toBe("grey");
});

test("only the page changes what is fixed: edits, queries and undo do not", () => {
  wishes.change({ height: "10" });
  wishes.fixed = settingsOf(["printer", "format", "layer-min"]);
  attributes.set("printer", "mars");
  attributes.set("format", "uvj");
  wishes.change({ printer: "", format: "png", layerMin: "0.01", height: "20" });
  const fixed = { printer: "mars", format: "uvj", layerMin: "0.05" };
  expect(wishes.settings).toMatchObject({ ...fixed, height: "20" });
  wishes.undo();
  expect(wishes.settings).toMatchObject({ ...fixed, height: "10" });
  wishes.undo();
  expect(wishes.settings).toMatchObject({ ...fixed, height: "" });
  wishes.redo();
  expect(wishes.settings).toMatchObject({ ...fixed, height: "10" });
  wishes.restore(fromAddress("printer=saturn&format=png&layerMin=0.01&metric=area"));
  expect(wishes.settings).toMatchObject({ ...fixed, metric: "area", height: "" });
  attributes.set("printer", "saturn");
  expect(wishes.settings.printer).toBe("saturn");
});

test("nobody brings a printer of their own where the page has fixed one", () => {
  const own: Printer = { name: "mars", pixels: [1, 1], pitch_um: [50, 50], volume_mm: [1, 1, 1] };
  wishes.fixed = settingsOf(["printer"]);
  attributes.set("printer", "mars");
  wishes.change({ printer: own });
  wishes.restore(fromAddress(toAddress({ ...DEFAULT_SETTINGS, printer: own })));
  expect(wishes.settings.printer).toBe("mars");
});
