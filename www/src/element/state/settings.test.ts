import { expect, expectTypeOf, test } from "vitest";
import { FORMATS, sameRays } from "../../api/facts.js";
import type { Format, Printer } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { knownPrinter } from "./printer-fixture.js";
import {
  check,
  DEFAULT_SETTINGS,
  faultWords,
  fromAddress,
  parse,
  quaternion,
  rotationText,
  toAddress,
  type Field,
  type Offered,
  type Settings,
  usualTolerance,
  withFormat,
  withNozzle,
  withPrinter,
  withTolerance,
} from "./settings.js";

/** The faults in English. */
function faults(patch: Partial<Settings>, offered: Offered = { printers: [], resins: [] }): Partial<Record<Field, string>> {
  const checked = check({ ...DEFAULT_SETTINGS, ...patch }, offered);
  if (checked.ok) return {};
  return Object.fromEntries(Object.entries(checked.faults).map(([field, fault]) => [field, faultWords(fault, languageOf("en"))]));
}

function options(patch: Partial<Settings>): unknown {
  const checked = check({ ...DEFAULT_SETTINGS, ...patch });
  return checked.ok ? checked.options : checked.faults;
}

test("the default settings are the core's defaults", () => {
  expect(options({})).toEqual({
    rays: 2048,
    layer_min_mm: 0.05,
    layer_max_mm: 0.15,
    metric: "cusp",
    minimize: "layers",
    snap: "auto",
    planner: { kind: "optimal" },
  });
});

test.each([
  ["cusp", "0.065", "0.05", 0.05],
  ["deviation", "0.0325", "0.01", 0.01],
  ["filament-roundness", "0.065", "0.06", 0.06],
  ["roughness", "0.1", "0,2", 0.2],
  ["area", "10", "5", 0.05],
  ["volume", "1", "20", 20],
] as const)("the tolerance of %s is %s until one is typed, and is sent in the core's unit", (metric, usual, typed, sent) => {
  const settings = { ...DEFAULT_SETTINGS, metric };
  expect(usualTolerance(metric, null)).toBe(usual);
  expect(options(settings)).not.toHaveProperty("tolerance");
  const changed = { ...settings, ...withTolerance(settings, typed) };
  expect(options(changed)).toMatchObject({ metric, tolerance: sent });
  expect(options({ ...changed, ...withTolerance(changed, " ") })).not.toHaveProperty("tolerance");
});

test("a tolerance belongs to the metric that it was typed for", () => {
  const cusp = { ...DEFAULT_SETTINGS, ...withTolerance(DEFAULT_SETTINGS, "0.05") };
  const area = { ...cusp, metric: "area" as const };
  expect(options(area)).not.toHaveProperty("tolerance");
  const both = { ...area, ...withTolerance(area, "x") };
  expect(faults(both).tolerance).toMatch(/0.1 to 200 %/);
  expect(options({ ...both, metric: "cusp" })).toMatchObject({ tolerance: 0.05 });
});

test("a tolerance that the core chose is rounded to few digits, never down", () => {
  expect(usualTolerance("volume", 11.2631)).toBe("11.3");
  expect(usualTolerance("area", 0.07)).toBe("7");
});

test.each([
  ["0.05", 0.05],
  [" 0,05 ", 0.05],
  [".5", 0.5],
  ["12.", 12],
  ["0", 0],
  ["", null],
  ["-1", null],
  ["abc", null],
])("the setting %j is %j", (text, value) => {
  expect(parse(text)).toBe(value);
});

test("a height is optional, and checked only if given", () => {
  expect(options({ height: "60" })).toMatchObject({ height_mm: 60 });
  expect(faults({ height: " " })).toEqual({});
  expect(faults({ height: "tall" }).height).toMatch(/number/);
  expect(faults({ height: "0" }).height).toMatch(/0.1 to 1,000/);
});

test("a reversed range is a fault of its upper end", () => {
  expect(faults({ layerMin: "0.2", layerMax: "0.1" })).toEqual({
    layerMax: "The thickest layer must not be thinner than the thinnest.",
  });
});

test("micrometres typed for millimetres are recognised", () => {
  expect(faults({ tolerances: { cusp: "65" } }).tolerance).toMatch(/65 µm is 0.065 mm/);
  expect(faults({ step: "10" }).step).toMatch(/10 µm is 0.01 mm/);
  expect(faults({ height: "6000" }).height).toBe("Must be 0.1 to 1,000 mm.");
  expect(faults({ metric: "area", tolerances: { area: "1000" } }).tolerance).toBe("Must be 0.1 to 200 %.");
});

test("a unit that does not fit, and separated thousands, are faults with words", () => {
  expect(faults({ tolerances: { cusp: "5 s" } }).tolerance).toBe("This field takes mm, µm, cm, in, or thou.");
  expect(faults({ exposure: "5 mm" }).exposure).toBe("This field takes s, ms, or min.");
  expect(faults({ metric: "area", tolerances: { area: "5 mm" } }).tolerance).toBe("This field takes %.");
  expect(faults({ height: "1.000,5" }).height).toBe("Enter the number without a thousands separator.");
  expect(faults({ bottomLayers: "6 mm" }).bottomLayers).toBe("Enter a number, 0 to 100.");
});

test("the uniform thickness counts only for the uniform planner", () => {
  expect(faults({ uniform: "x" })).toEqual({});
  expect(faults({ planner: "uniform", uniform: "x" }).uniform).toMatch(/number/);
  expect(options({ planner: "uniform", uniform: "0.1" })).toMatchObject({ planner: { kind: "uniform", layer_mm: 0.1 } });
});

test("the size of bins is left to the core", () => {
  for (const patch of [{ layerMin: "0.025" }, { planner: "uniform", uniform: "0.0355" }, { step: "0.0025" }] as const) {
    expect(options(patch)).not.toHaveProperty("bin_mm");
  }
});

test("settings of adaptive plans are neither checked nor sent for uniform ones", () => {
  const uniform = options({ planner: "uniform", step: "x", minimize: "time", snap: "off" });
  for (const key of ["step_mm", "minimize", "snap"]) expect(uniform).not.toHaveProperty(key);
  expect(options({ step: "0.01", minimize: "time", snap: "off" })).toMatchObject({ step_mm: 0.01, minimize: "time", snap: "off" });
  expect(faults({ step: "x" }).step).toMatch(/number/);
});

test("a query sets settings, and unknown keys and choices are ignored", () => {
  expect(fromAddress("?height=60&rays=4096&planner=uniform&uniform=0.1&backend=gpu")).toEqual({
    ...DEFAULT_SETTINGS,
    height: "60",
    rays: "4096",
    planner: "uniform",
    uniform: "0.1",
  });
  expect(fromAddress("?tolerance=5&metric=area&minimize=time&snap=off&step=0.01")).toEqual({
    ...DEFAULT_SETTINGS,
    metric: "area",
    tolerances: { area: "5" },
    minimize: "time",
    snap: "off",
    step: "0.01",
  });
  expect(fromAddress("?rays=7&planner=best&metric=beauty&minimize=cost&snap=on&constructor=1")).toEqual(DEFAULT_SETTINGS);
});

test("names of earlier versions are known", () => {
  expect(fromAddress("?spare=on").protect).toBe("on");
  expect(fromAddress("?metric=thread").metric).toBe("filament-roundness");
});

test("numbers of a query may have a decimal comma and a unit, and become canonical", () => {
  expect(fromAddress("?height=60,125&layerMin=50um&tolerance=0,05&exposure=2500ms")).toEqual({
    ...DEFAULT_SETTINGS,
    height: "60.125",
    tolerances: { cusp: "0.05" },
    exposure: "2.5",
  });
  expect(fromAddress("?metric=area&tolerance=5%25").tolerances).toEqual({ area: "5" });
  // Unreadable text is kept, and explained at its field.
  expect(fromAddress("?height=1.000,5&step=x")).toMatchObject({ height: "1.000,5", step: "x" });
});

test("sameRays() compares only the options that move the rays", () => {
  expect(sameRays({ rays: 1024, tolerance: 0.05 }, { rays: 1024, metric: "area" })).toBe(true);
  expect(sameRays({ rays: 1024 }, { rays: 2048 })).toBe(false);
  expect(sameRays({ height_mm: 60 }, {})).toBe(false);
  expect(sameRays({ pixels: [1, 2] }, { pixels: [1, 2] })).toBe(true);
  const own = (): Printer => ({ pixels: [1, 2], pitch_um: [50, 50], volume_mm: [1, 1, 1] });
  expect(sameRays({ printer: own() }, { printer: own() })).toBe(true);
  expect(sameRays({ printer: own() }, { printer: "saturn" })).toBe(false);
});

test("a query has only the settings that differ from the defaults, and restores them", () => {
  expect(toAddress(DEFAULT_SETTINGS)).toBe("");
  const settings: Settings = {
    ...DEFAULT_SETTINGS,
    metric: "area",
    tolerances: { area: "5" },
    height: "60",
    printer: "sl1s",
    format: "uvj",
    bottomLayers: "6",
    rotation: "0,0,1,0",
  };
  expect(toAddress(settings)).toBe("metric=area&format=uvj&height=60&bottomLayers=6&printer=sl1s&rotation=0%2C0%2C1%2C0&tolerance=5");
  expect(fromAddress(toAddress(settings))).toEqual(settings);
});

test("the form offers every print format", () => {
  expectTypeOf<(typeof FORMATS)[number]>().toEqualTypeOf<Format>();
  for (const format of FORMATS) expect(fromAddress(`format=${format}`).format).toBe(format);
});

const PRINTER = knownPrinter({ name: "p" });

test("a printer sets the pixels and the limits of layer thickness", () => {
  const offered: Offered = { printers: [PRINTER], resins: [] };
  expect(options({ printer: "p" })).toMatchObject({ printer: "p" });
  expect(options({ printer: "p" })).not.toHaveProperty("rays");
  expect(faults({ printer: "p", layerMax: "0.3" }, offered).layerMax).toBe("Must be 0.02 to 0.2 mm.");
  expect(faults({ layerMax: "0.3" }, offered)).toEqual({});
});

test("a printer of one's own goes to the core as it is described, and into a query", () => {
  const own = { pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245] } satisfies Printer;
  expect(options({ printer: own })).toMatchObject({ printer: own });
  expect(options({ printer: own })).not.toHaveProperty("rays");
  expect(faults({ printer: { ...own, layer_mm: [0.03, 0.1] } }).layerMax).toBe("Must be 0.03 to 0.1 mm.");
  expect(faults({ printer: { ...own, layer_mm: 7 } as unknown as Printer })).toEqual({});
  const settings = { ...DEFAULT_SETTINGS, printer: own };
  expect(fromAddress(toAddress(settings))).toEqual(settings);
});

test("a resin is the page's, overridden by what is typed", () => {
  const resins = [{ name: "tough", exposure_s: 4, wait_s: 2 }];
  const checked = check({ ...DEFAULT_SETTINGS, resin: "tough", exposure: "3,5", bottomLayers: "6" }, { printers: [], resins });
  expect(checked).toMatchObject({ ok: true, options: { resin: { name: "tough", exposure_s: 3.5, wait_s: 2, bottom_layers: 6 } } });
  expect(options({})).not.toHaveProperty("resin");
  expect(faults({ bottomLayers: "2.5" }).bottomLayers).toMatch(/whole number/);
  expect(faults({ exposure: "0" }).exposure).toBe("Must be 0.1 to 600 s.");
});

test("a rotation is written with few digits, and the identity as empty text", () => {
  expect(rotationText([0, 0, 0, 1])).toBe("");
  expect(rotationText([0, -0, Math.SQRT1_2, Math.SQRT1_2])).toBe("0,0,0.707107,0.707107");
});

test("a rotation is four numbers, normalised; anything else gives null", () => {
  expect(quaternion("0,0,2,0")).toEqual([0, 0, 1, 0]);
  expect(["", "1,2", "0,0,0,0", "a,b,c,d", "1,2,3,4,5"].map(quaternion)).toEqual([null, null, null, null, null]);
});

test("a format for filament printers brings its limits, and takes them away again", () => {
  const chosen = { ...DEFAULT_SETTINGS, printer: "saturn-3", ...withFormat(DEFAULT_SETTINGS, "prusa-3mf") };
  expect(chosen).toMatchObject({ format: "prusa-3mf", printer: "", layerMin: "0.07", layerMax: "0.3" });
  expect(options(chosen)).toMatchObject({ format: "prusa-3mf", layer_min_mm: 0.07, layer_max_mm: 0.3 });
  expect(usualTolerance("cusp", null, "prusa-3mf")).toBe("0.091");
  expect({ ...chosen, ...withFormat(chosen, "orca-3mf") }).toMatchObject({ layerMin: "0.08", layerMax: "0.28" });
  expect({ ...chosen, ...withFormat(chosen, "") }).toEqual(DEFAULT_SETTINGS);
  // A typed value stays.
  const typed = { ...chosen, layerMax: "0.25" };
  expect({ ...typed, ...withFormat(typed, "") }).toEqual({ ...DEFAULT_SETTINGS, layerMax: "0.25" });
  // A resin printer has its own format.
  expect({ ...chosen, ...withPrinter(chosen, "saturn-3") }).toEqual({ ...DEFAULT_SETTINGS, printer: "saturn-3" });
  const goo = { ...DEFAULT_SETTINGS, format: "goo" } as const;
  expect(withPrinter(goo, "saturn-3")).toEqual({ printer: "saturn-3" });
});

test("a nozzle brings its limits, unless others are typed, and is for filament printers alone", () => {
  const chosen = { ...DEFAULT_SETTINGS, ...withFormat(DEFAULT_SETTINGS, "orca-3mf") };
  const wide = { ...chosen, ...withNozzle(chosen, "0.6") };
  expect(wide).toMatchObject({ nozzle: "0.6", layerMin: "0.12", layerMax: "0.42", uniform: "0.3" });
  expect(options(wide)).toMatchObject({ nozzle_mm: 0.6, layer_min_mm: 0.12, layer_max_mm: 0.42 });
  expect(usualTolerance("cusp", null, "orca-3mf", "0.6")).toBe("0.156");
  expect({ ...wide, ...withNozzle(wide, "") }).toEqual(chosen);
  // An invalid nozzle, such as one half typed, implies the limits of the usual nozzle.
  expect({ ...wide, ...withNozzle(wide, "0.") }).toMatchObject({ layerMin: "0.08", layerMax: "0.28" });
  const typed = { ...chosen, layerMax: "0.2" };
  expect({ ...typed, ...withNozzle(typed, "0.6") }).toMatchObject({ layerMin: "0.12", layerMax: "0.2" });
  expect(check({ ...chosen, nozzle: "4" })).toMatchObject({ ok: false, faults: { nozzle: { kind: "range", least: 0.15, most: 2 } } });
  expect(options({ ...wide, ...withFormat(wide, "goo") })).not.toHaveProperty("nozzle_mm");
});

test.each(["format=orca-3mf&nozzle=0.6", "format=prusa-3mf&layerMax=0.3&nozzle=0.8"])("the nozzle of the address %s stays as it is", (query) => {
  expect(toAddress(fromAddress(query))).toBe(query);
});

test.each(["format=prusa-3mf", "format=orca-3mf", "format=orca-3mf&layerMax=0.15"])("the address %s stays as it is", (query) => {
  const settings = fromAddress(query);
  expect(settings.layerMin).toBe(query.includes("prusa") ? "0.07" : "0.08");
  expect(toAddress(settings)).toBe(query);
});

test("walls make a model hollow, which drains unless that is turned off, and are for resin printers alone", () => {
  const hollow = { ...DEFAULT_SETTINGS, wall: "1.5" };
  expect(options(DEFAULT_SETTINGS)).not.toHaveProperty("hollow");
  expect(options(hollow)).toMatchObject({ hollow: { wall_mm: 1.5, auto_drain: {} } });
  // One setting controls both supports and holes.
  expect(options({ ...hollow, protect: "on" })).toHaveProperty("hollow", { wall_mm: 1.5, auto_drain: { protect: true } });
  expect(options({ ...hollow, protect: "on", supports: "light" })).toMatchObject({ supports: { protect: true }, hollow: { auto_drain: { protect: true } } });
  expect(options({ ...hollow, infill: "lattice", drain: "none" })).toHaveProperty("hollow", { wall_mm: 1.5, infill: {} });
  expect(check({ ...hollow, wall: "0.3" })).toMatchObject({ ok: false, faults: { wall: { kind: "range", least: 0.4, most: 50 } } });
  expect(options({ ...hollow, ...withFormat(hollow, "prusa-3mf") })).not.toHaveProperty("hollow");
  expect(toAddress({ ...hollow, infill: "lattice" })).toBe("infill=lattice&wall=1.5");
  expect(fromAddress("infill=lattice&wall=1.5")).toEqual({ ...hollow, infill: "lattice" });
});

test("supports are of a strength, and for resin printers alone", () => {
  const supported = { ...DEFAULT_SETTINGS, supports: "light" as const };
  expect(options(DEFAULT_SETTINGS)).not.toHaveProperty("supports");
  expect(options(supported)).toMatchObject({ supports: { strength: "light" } });
  expect(options({ ...supported, ...withFormat(supported, "prusa-3mf") })).not.toHaveProperty("supports");
  expect(toAddress(supported)).toBe("supports=light");
  expect(fromAddress("supports=light")).toEqual(supported);
});

test("sizes of supports replace those of the strength, if they differ", () => {
  const supported = { supports: "light", lift: "8", supportSpacing: "2.5", contact: "0,35" } as const;
  // The spacing is that of the strength.
  expect(options(supported)).toMatchObject({ supports: { strength: "light", profile: { lift_mm: 8, contact_mm: 0.35 } } });
  expect(options({ supports: "light", lift: " ", supportSpacing: "2.5" })).toHaveProperty("supports", { strength: "light" });
  expect(options({ ...supported, supports: "none", lift: "x" })).not.toHaveProperty("supports");
});

test.each([
  ["45", { self_supporting_slope: 1 }],
  ["20", { self_supporting_slope: 0.364 }],
  ["30", undefined],
])("an angle of %s° is the slope %j", (supportAngle, profile) => {
  expect(options({ supports: "heavy", supportAngle })).toHaveProperty("supports", { strength: "heavy", ...(profile && { profile }) });
});

test("a raft has sizes once it is on", () => {
  const sizes = { supports: "medium", raftThickness: "1.5", raftMargin: "0" } as const;
  expect(options({ ...sizes, raftThickness: "x" })).toHaveProperty("supports", { strength: "medium" });
  expect(options({ ...sizes, raft: "on" })).toHaveProperty("supports.profile", { raft: true, raft_thickness_mm: 1.5, raft_margin_mm: 0 });
  expect(faults({ ...sizes, raft: "on", raftThickness: "0.1" }).raftThickness).toBe("Must be 0.2 to 4 mm.");
  // Supports need room between raft and model.
  expect(faults({ ...sizes, raft: "on", raftThickness: "4.5" }).raftThickness).toBe("Must be 0.2 to 4 mm.");
  expect(faults({ ...sizes, raft: "on", lift: "2" })).toEqual({ lift: "Must be 2.5 to 50 mm." });
  expect(faults({ ...sizes, raft: "on", lift: "2", raftThickness: "" })).toEqual({});
  expect(faults({ ...sizes, lift: "0" })).toEqual({});
});

test("sizes of supports are within the core's bounds, and a pillar is no wider than its foot", () => {
  expect(faults({ supports: "light", supportSpacing: "0.4", pillar: "3.5", supportAngle: "89", lift: "6000" })).toEqual({
    supportSpacing: "Must be 0.5 to 50 mm.",
    pillar: "Must be 0.3 to 3 mm.",
    supportAngle: "Must be 1 to 88°.",
    lift: "Must be 0 to 50 mm. 6,000 µm is 6 mm.",
  });
});

test("layers below the model are for supported models with adaptive layers", () => {
  const thick = { supports: "light", supportLayer: "0.2" } as const;
  expect(options(thick)).toMatchObject({ support_layer_mm: 0.2, layer_max_mm: 0.15 });
  expect(options({ ...thick, points: "none" })).toHaveProperty("support_layer_mm", 0.2);
  for (const other of [{ supports: "none" }, { planner: "uniform" }, { format: "prusa-3mf" }] as const) {
    expect(options({ ...thick, supportLayer: "x", ...other })).not.toHaveProperty("support_layer_mm");
    expect(faults({ ...thick, supportLayer: "x", ...other })).not.toHaveProperty("supportLayer");
  }
  expect(faults({ ...thick, printer: "p", supportLayer: "0.3" }, { printers: [PRINTER], resins: [] }).supportLayer).toBe("Must be 0.02 to 0.2 mm.");
  expect(faults({ ...thick, supportLayer: "0.04" }).supportLayer).toMatch(/not be thinner/);
});

test("a query keeps the sizes of supports", () => {
  const query = "supports=light&raft=on&supportLayer=0.2&lift=8&supportSpacing=2&contact=0.5&pillar=1.2&supportAngle=40&raftThickness=1.5&raftMargin=3";
  expect(fromAddress(query)).toMatchObject({ raft: "on", supportLayer: "0.2", lift: "8", supportAngle: "40", raftMargin: "3" });
  expect(toAddress(fromAddress(query))).toBe(query);
  expect(fromAddress("supportAngle=40%C2%B0&lift=0,8cm")).toMatchObject({ supportAngle: "40", lift: "8" });
});
