import { expect, test } from "vitest";
import { choose, formatFor } from "./choice.js";
import { rows, sentence as sentenceIn, type Compared } from "./comparison.js";
import { SlicerError, ERROR_CODES, type ErrorCode } from "../../api/error.js";
import { WARNING_CODES } from "../../api/warning.js";
import { languageOf, LANGUAGES, type Language } from "../../texts/index.js";
import { fileWords } from "../parts/file-words.js";
import { explain as explainIn, warningWords } from "./problem.js";
import { standing } from "../parts/progress.js";
import { gainWords, pictureOf } from "../panels/quality.js";
import * as round from "./round.js";
import { check, DEFAULT_SETTINGS, type Settings } from "./settings.js";
import type { Format as PrintFormat, Options, PlannerReport, Printer, Report, Stage, Warning } from "../../api/wire.js";

const english = languageOf("en");
const { format } = english;
const sentence = (compared: Compared): string => sentenceIn(compared, english);

function explain(
  error: SlicerError,
  name: string,
  settings: Settings,
  fixed: readonly (keyof Settings)[] = [],
): ReturnType<typeof explainIn> {
  return explainIn({ error, name, settings, height_mm: 60 }, english, new Set(fixed));
}

const limits = [0.05, 0.15] as const;

const uniform = (layers: number, max_error: number, print_time_s: number): PlannerReport => ({
  planner: "uniform",
  layers,
  max_error,
  print_time_s,
});

function report(patch: Partial<Report>): Report {
  return {
    schema: 1,
    stl: { bytes: 0, crc32: 0 },
    options: {},
    layers: 793,
    height_mm: 60,
    z_mm: [],
    thickness_mm: [],
    snapped_mm: [],
    metric: "cusp",
    unit: "mm",
    source: "exact",
    tolerance: 0.065,
    max_error: 0.065,
    sampled_error: 0.065,
    max_error_mm: 0.065,
    print_time_s: 9000,
    planner: "optimal",
    backend: "cpu",
    adapter: null,
    bins: 30_000,
    bin_mm: 0.002,
    facets: 69_451,
    weights_crc32: null,
    hits: 5_218_540,
    uniform: { finest: uniform(1200, 0.05, 13_200), coarsest: uniform(400, 0.15, 5_538) },
    exposure_s: [],
    overhead_s: 7.6,
    resin: {},
    resin_ml: 44.4,
    printer: null,
    print_file: { format: "png", extension: "zip", media_type: "application/zip", is_read_by_printer: false },
    mask: { width: 2048, height: 1588, pitch_mm: 0.0293, pitch_y_mm: 0.0293, antialias: 1, is_mirrored: false },
    warnings: [],
    timings_ms: { load: 0, ldi: 0, profile: 0, plan: 0, masks: 0, total: 0 },
    ...patch,
  };
}

const compared = (patch: Partial<Report>, options: Options = {}): Compared => ({ report: report(patch), limits, options });

test("the gain over the finest uniform plan, in layers or in time", () => {
  expect(sentence(compared({}))).toBe("34% fewer than uniform 0.05\u00a0mm (1,200), same tolerance.");
  expect(sentence(compared({}, { minimize: "time" }))).toBe(
    "32% less time than uniform 0.05\u00a0mm (3\u00a0h\u00a040\u00a0min), same tolerance.",
  );
});

test("a plan that gains nothing says so", () => {
  expect(sentence(compared({ layers: 1200 }))).toMatch(/^As many as uniform 0.05/);
  expect(sentence(compared({ print_time_s: 13_200 }, { minimize: "time" }))).toMatch(/^As slow as uniform 0.05/);
});

test("a plan as short as the coarsest, where that holds", () => {
  const both = { finest: uniform(1200, 0.01, 13_200), coarsest: uniform(400, 0.03, 5_538) };
  expect(sentence(compared({ layers: 400, uniform: both }))).toMatch(/^As few as uniform 0.15/);
  expect(sentence(compared({ print_time_s: 5_538, uniform: both }, { minimize: "time" }))).toMatch(/^As quick as uniform 0.15/);
});

test("a plan that is longer than the coarsest, which holds too, does not hide that", () => {
  const both = { finest: uniform(1200, 0.01, 13_200), coarsest: uniform(792, 0.03, 5_538) };
  expect(sentence(compared({ uniform: both }))).toMatch(/^34% fewer than .*, but uniform 0.15\u00a0mm keeps the tolerance as well\.$/);
});

test("a uniform plan over the tolerance says by how much, in the unit of its metric", () => {
  const over = { planner: "uniform", max_error: 0.1 };
  expect(sentence(compared(over))).toMatch(/reaches 0.1\u00a0mm, more than the 0.065/);
  expect(sentence(compared({ ...over, metric: "area" }))).toBe("The error reaches 10%, more than the 6.5% allowed.");
  expect(sentence(compared({ ...over, metric: "volume", max_error: 11.26 }))).toMatch(/reaches 11.26\u00a0mm³/);
});

test("the coarsest row says that it breaks the tolerance; rounding of sums does not count", () => {
  expect(rows(compared({ max_error: 0.0650000001 })).map(({ holds }) => holds)).toEqual([true, true, false]);
});

/** Of these only a few figures count. */
const failed = (code: ErrorCode, message: string, detail: object = {}): SlicerError =>
  new SlicerError(code as "crash", message, detail as unknown as null);

function infeasible(detail: Record<string, number | null>): SlicerError {
  const where = { from_mm: 12.34, to_mm: 12.39, tolerance: 0.02, layer_min_mm: 0.05 };
  return failed("infeasible", "no plan", { ...where, ...detail });
}

const infeasibleAt = (patch: Partial<Settings>, detail: Record<string, number | null>): ReturnType<typeof explain> =>
  explain(infeasible(detail), "bunny.stl", { ...DEFAULT_SETTINGS, ...patch });

test("infeasible: where, and the two ways out that the core knows, rounded so that they are ones", () => {
  const problem = infeasibleAt({}, { least_tolerance: 0.0498731, largest_layer_min_mm: 0.02 });
  expect(problem.title).toBe("No plan keeps 0.02\u00a0mm all the way up");
  expect(problem.text).toBe(
    "From 12.340 to 12.390\u00a0mm even a layer of 0.05\u00a0mm, the thinnest allowed, leaves a larger error. " +
      "Allow a larger error, or thinner layers if your printer can make them.",
  );
  expect(problem.offers).toEqual([
    { label: "Tolerance 0.05\u00a0mm", change: { tolerances: { cusp: "0.05" } } },
    { label: "Layers from 0.02\u00a0mm", change: { layerMin: "0.02" } },
  ]);
});

test("infeasible: only what the core knows is offered", () => {
  const tolerance = infeasibleAt({}, { least_tolerance: 0.05, largest_layer_min_mm: null });
  expect(tolerance.offers.map(({ change }) => change)).toEqual([{ tolerances: { cusp: "0.05" } }]);
  expect(tolerance.text).toMatch(/Allow a larger error\.$/);
  expect(infeasibleAt({}, { least_tolerance: null, largest_layer_min_mm: null }).offers).toEqual([]);
});

test.each([
  ["roughness", 0.0999271, "0.1", "Tolerance 0.1\u00a0mm"],
  ["area", 0.0712345, "7.13", "Tolerance 7.13%"],
  ["volume", 137.234, "138", "Tolerance 138\u00a0mm³"],
] as const)("infeasible by %s: the least tolerance in its unit, for that metric alone", (metric, least, text, label) => {
  const problem = infeasibleAt(
    { metric, tolerances: { cusp: "0.05" } },
    { least_tolerance: least, largest_layer_min_mm: null },
  );
  expect(problem.offers).toEqual([{ label, change: { tolerances: { cusp: "0.05", [metric]: text } } }]);
});

test.each([
  [{}, 0.024, "0.024"],
  // With bins of 1 µm the core found 52 µm: at 2 µm that could fail, at 51 µm the bins stay.
  [{ layerMin: "0.055" }, 0.052, "0.051"],
  [{ layerMin: "0.055", layerMax: "0.155" }, 0.052, "0.052"],
  [{ step: "0.0025" }, 0.0475, "0.047"],
])("thinner layers are offered only where the core looks at the same bins: %j", (patch, largest, layerMin) => {
  const [offer] = infeasibleAt(patch, { least_tolerance: null, largest_layer_min_mm: largest }).offers;
  expect(offer?.change).toEqual({ layerMin });
  const bin = (settings: Partial<Settings>): unknown => {
    const checked = check({ ...DEFAULT_SETTINGS, ...settings });
    return checked.ok ? checked.options.bin_mm : checked.faults;
  };
  expect(bin({ ...patch, ...offer?.change })).toEqual(bin(patch));
});

test("rounding up is short and never below; rounding down gives whole micrometres", () => {
  expect([0.0500001, 0.05, 0.07, 0.0655, 11.2631, 137.234, 1234.5].map(round.up)).toEqual([
    0.051, 0.05, 0.07, 0.066, 11.3, 138, 1235,
  ]);
  expect([0.0475, 0.048, 0.057].map(round.micrometreBelow)).toEqual([0.047, 0.048, 0.057]);
});

test("layers that do not add up: thinner ones may", () => {
  const problem = explain(failed("layers-do-not-fit", "no"), "a.stl", DEFAULT_SETTINGS);
  expect(problem.offers.map(({ change }) => change)).toEqual([{ layerMin: "0.025" }]);
});

test("the core's message becomes a sentence under our heading", () => {
  const problem = explain(failed("stl-truncated", "the file ends at byte 90"), "a.stl", DEFAULT_SETTINGS);
  expect(problem.title).toBe("a.stl is cut short");
  expect(problem.text).toBe("The file ends at byte 90.");
});

test.each([
  ["no-hits", "a.stl is too thin for these pixels"],
  ["all-black", "Every mask would be black"],
  ["layer-too-thick", "The layers are too thick for this model"],
  ["layer-range-empty", "No layer of whole motor steps lies in this range"],
  ["gpu-too-small", "The GPU is too small for this model"],
  ["out-of-reach", "No plan is as short as that"],
] as const)("%s has a heading of its own", (code, title) => {
  expect(explain(failed(code, "x"), "a.stl", DEFAULT_SETTINGS).title).toBe(title);
});

test("out of memory offers half the rays, down to the least there is", () => {
  const error = failed("out-of-memory", "too much");
  expect(explain(error, "a.stl", DEFAULT_SETTINGS).offers[0]?.change).toEqual({ rays: "1024" });
  expect(explain(error, "a.stl", { ...DEFAULT_SETTINGS, rays: "512" }).offers).toEqual([]);
});

test("a model that is too large may be scaled to fit, or the printer left out", () => {
  const error = failed("model-too-large", "too large", { fitting_scale: 0.5012 });
  const problem = explain(error, "a.stl", { ...DEFAULT_SETTINGS, printer: "p" });
  expect(problem.field).toBe("printer");
  expect(problem.offers).toEqual([
    { label: "Scale to 30\u00a0mm", change: { height: "30" } },
    { label: "Without a printer", change: { printer: "" } },
  ]);
});

test("what the page has fixed is not offered to be changed", () => {
  const large = failed("model-too-large", "too large", { fitting_scale: 0.5012 });
  const { offers } = explain(large, "a.stl", { ...DEFAULT_SETTINGS, printer: "p" }, ["printer", "format"]);
  expect(offers).toEqual([{ label: "Scale to 30\u00a0mm", change: { height: "30" } }]);
  expect(explain(failed("uniform-only", ""), "a.stl", DEFAULT_SETTINGS, ["format"]).offers).toHaveLength(1);

  const neither = infeasible({ least_tolerance: 0.05, largest_layer_min_mm: 0.02 });
  const [thinner, larger, none] = ([["tolerances"], ["layerMin"], ["tolerances", "layerMin"]] as const).map((fixed) =>
    explain(neither, "a.stl", DEFAULT_SETTINGS, fixed),
  );
  expect([thinner, larger, none].map((it) => it?.offers.map(({ change }) => Object.keys(change)))).toEqual([
    [["layerMin"]],
    [["tolerances"]],
    [],
  ]);
  expect(thinner?.text).toMatch(/Allow thinner layers if your printer can make them\.$/);
  expect(larger?.text).toMatch(/Allow a larger error\.$/);
  expect(none?.text).toMatch(/leaves a larger error\.$/);
});

test("a file for uniform layers offers these, or another file", () => {
  const { field, offers } = explain(failed("uniform-only", ""), "a.stl", { ...DEFAULT_SETTINGS, format: "sl1" });
  expect(field).toBe("format");
  expect(offers.map(({ change }) => change)).toEqual([{ planner: "uniform" }, { format: "png" }]);
});

test.each(LANGUAGES)("every code has a heading and a sentence: %s", (locale) => {
  const language = languageOf(locale);
  for (const code of Object.keys(ERROR_CODES) as ErrorCode[]) {
    const failure = { error: failed(code, "why", { kind: "obj" }), name: "a.stl", settings: DEFAULT_SETTINGS, height_mm: 1 };
    const { title, text } = explainIn(failure, language, new Set());
    expect(title.length, code).toBeGreaterThan(3);
    expect(text.length, code).toBeGreaterThan(2);
  }
});

test.each([
  [[], []],
  // The core looks inside and says what it is.
  [["a.txt", "b.3mf"], ["a.txt"]],
  [["A.STL"], ["A.STL"]],
  [["model"], ["model"]],
  [["notes.txt", "b.stl", "c.stl"], ["b.stl", "c.stl"]],
])("of %j the STLs are taken", (names, taken) => {
  expect(choose(names.map((name) => ({ name }))).map(({ name }) => name)).toEqual(taken);
});

test.each([
  ["3mf", "a is a file of another kind: 3MF", /Export the model as STL/],
  ["gzip", "a is a file of another kind: gzip", /Unpack it/],
  ["html", "a is a file of another kind: HTML", /web page/],
] as const)("a file of another kind is named: %s", (kind, title, text) => {
  const problem = explain(new SlicerError("other-file-kind", "", { kind }), "a", DEFAULT_SETTINGS);
  expect(problem.title).toBe(title);
  expect(problem.text).toMatch(text);
});

test("warnings are sentences with their figures, in every language", () => {
  const metric = "cusp";
  const warnings: Warning[] = [
    { code: "degenerate-facets", detail: { facets: 1 } },
    { code: "inside-out" },
    { code: "open-mesh", detail: { open_edges: 3, holes: 1 } },
    { code: "unclosed-rays", detail: { unclosed: 12, rays: 3456 } },
    { code: "tolerance-exceeded", detail: { planner: "uniform", metric, tolerance: 0.05, max_error: 0.0712 } },
    { code: "tolerance-exceeded-on-mesh", detail: { metric, tolerance: 0.05, max_error: 0.0712 } },
    { code: "sampled-sections" },
    { code: "top-moved", detail: { top_mm: 9.95, height_mm: 10 } },
    { code: "black-layers", detail: { layers: 64, from_mm: 1 } },
    { code: "gpu-too-small", detail: { needed_bytes: 2, limit_bytes: 1 } },
    { code: "gpu-failed", detail: { reason: "lost" } },
  ];
  expect(warnings.map(({ code }) => code)).toEqual(Object.keys(WARNING_CODES));
  const words = (locale: string): string[] => warnings.map((warning) => warningWords(warning, languageOf(locale)));
  expect(words("en")[0]).toBe("1 facet without area left out.");
  expect(words("en")[4]).toBe("The error reaches 0.071\u00a0mm, more than the tolerance of 0.05\u00a0mm.");
  expect(words("en")[8]).toMatch(/^64 layers without a lit pixel, from 1\.000\u00a0mm up/);
  for (const locale of LANGUAGES) {
    const said = words(locale);
    expect(said.join(), locale).not.toMatch(/undefined|NaN/);
    expect(said[8], locale).toContain("64");
  }
});

const PRINTERS = (
  [
    ["saturn", "Saturn", "chitubox", ["ctb", "goo"], false],
    ["shuffle", "Shuffle", "chitubox", ["zip"], true],
    ["sl1s", "SL1S", "sl1", ["sl1s"], true],
  ] as const
).map(([name, model, format, reads, reads_format]): Printer => ({
  ...{ name, model, format, reads: [...reads], reads_format },
  ...{ pixels: [100, 100], pitch_um: [50, 50], volume_mm: [5, 5, 5], layer_mm: [0.02, 0.2], is_mirrored: true, step_mm: 0.002 },
}));

test("the format that settings stand for is the printer's own, if none is chosen", () => {
  expect(formatFor({ printer: "", format: "" }, PRINTERS)).toBe("png");
  expect(formatFor({ printer: "sl1s", format: "" }, PRINTERS)).toBe("sl1");
  expect(formatFor({ printer: "sl1s", format: "uvj" }, PRINTERS)).toBe("uvj");
});

test.each<[string, { printer?: string; format?: PrintFormat }, Report["planner"], string]>([
  ["no printer", {}, "optimal", "A zip of layer images."],
  ["no printer, a format", { format: "chitubox" }, "optimal", "A ChiTuBox zip."],
  ["one that needs a converter", { printer: "saturn" }, "optimal", "A ChiTuBox zip. The Saturn reads .ctb or .goo: convert it with UVtools first."],
  ["one that reads it", { printer: "shuffle" }, "optimal", "A ChiTuBox zip. The Shuffle reads it directly."],
  ["one that reads another zip", { printer: "shuffle", format: "png" }, "optimal", "A zip of layer images. The Shuffle cannot read it."],
  ["one that reads uniform layers", { printer: "sl1s" }, "uniform", "A Prusa SL1 file. The SL1S reads it directly."],
  [
    "one that reads uniform layers alone",
    { printer: "sl1s" },
    "optimal",
    "A Prusa SL1 file. This file has one thickness for all layers: choose uniform ones for it.",
  ],
])("before the download, %s: what the file is and what it needs", (_name, options, planner, said) => {
  const printer = PRINTERS.find(({ name }) => name === options.printer);
  const format = options.format ?? printer?.format ?? "png";
  const is_read_by_printer = printer?.reads_format === true && printer.format === format;
  const print_file = { format, extension: "", media_type: "", is_read_by_printer };
  const patch = { planner, print_file, printer: printer?.name ?? null };
  const words = (language: Language): string => fileWords({ report: report(patch) }, PRINTERS, language);
  expect(words(english)).toBe(`${said} The model prints as it is: no supports, not hollowed.`);
  const others = LANGUAGES.map((code) => words(languageOf(code)));
  expect(new Set(others).size).toBe(LANGUAGES.length);
  for (const other of others) expect(other).not.toContain("undefined");
});

test("numbers as people read them", () => {
  expect(format.duration(0.2)).toBe("< 1\u00a0ms");
  expect(format.duration(412.4)).toBe("412\u00a0ms");
  expect(format.duration(1340)).toBe("1.3\u00a0s");
  expect([20, 59, 3_570, 3_599, 48_000, 9_000_000].map(format.time)).toEqual([
    "<\u00a01\u00a0min",
    "1\u00a0min",
    "1\u00a0h\u00a00\u00a0min",
    "1\u00a0h\u00a00\u00a0min",
    "13\u00a0h\u00a020\u00a0min",
    "2,500\u00a0h\u00a00\u00a0min",
  ]);
  expect(format.percent(0.07125, 2)).toBe("7.13%");
  expect(format.volume(11.2631)).toBe("11.26\u00a0mm³");
  expect(format.dimensions([60, 46.52, 59.4])).toBe("60.0 × 46.5 × 59.4\u00a0mm");
});

test("progress never runs backwards over the stages of a plan, and an export counts its own", () => {
  const at = (stage: Stage, task: "plan" | "export"): number =>
    standing({ task, name: "", stage, fraction: 0.5, started_ms: 0 }, 0).done;
  const stages = (["load", "saliency", "ldi", "profile", "plan"] as const).map((stage) => at(stage, "plan"));
  expect(stages).toEqual([...stages].sort((a, b) => a - b));
  expect(new Set(stages).size).toBe(5);
  expect(at("masks", "export")).toBe(0.5);
  expect(at("ldi", "export")).toBe(0);
});

test("the time left is guessed from what is done, not before there is something to go by", () => {
  const at = (fraction: number, now_ms: number): number | null =>
    standing({ task: "export", name: "", stage: "masks", fraction, started_ms: 0 }, now_ms).left_s;
  expect(at(0.25, 5000)).toBe(15);
  expect(at(0.25, 500)).toBeNull();
  expect(at(0.01, 5000)).toBeNull();
});

test("a language is the first that there is a catalogue for, with the numbers of its country", () => {
  expect(languageOf("tlh", "de-CH").locale).toBe("de-CH");
  expect(languageOf("not a locale").locale).toBe("en");
  // What browsers call their language where nobody told the system one.
  for (const locale of ["C", "POSIX", "en-US@posix", "de_DE.UTF-8", ""]) {
    expect(languageOf(locale).format.size(1.5)).toBe("1.5");
    expect(languageOf(locale, "fr").locale).toBe("fr");
  }
  expect(languageOf("de").format.size(1234.5)).toBe("1.234,5");
  expect(languageOf("fr").texts.plan.layers(1)).toBe("couche");
  expect(languageOf("fr").texts.plan.layers(2)).toBe("couches");
  expect(languageOf("zh").format.time(3600)).toBe("1\u00a0小时\u00a00\u00a0分钟");
});

const curve = [0.05, 0.1, 0.2].map((max_error, i) => ({ tolerance: max_error, max_error, layers: 1, print_time_s: 300 - 100 * i }));

test("quality in words: the same for less time, or less for a larger deviation", () => {
  const words = (patch: Partial<Report>): string => gainWords({ report: report(patch), limits }, english);
  expect(words({ max_error: 0.05 })).toBe("Same quality as uniform 0.05\u00a0mm, 32% less time.");
  expect(words({})).toBe("32% less time than uniform 0.05\u00a0mm; the deviation is 0.065\u00a0mm instead of 0.05\u00a0mm.");
  expect(words({ print_time_s: 13_200 })).toMatch(/^As slow as uniform/);
});

test("the picture of the curve: finer to the right, longer upwards, each point over its notch", () => {
  const own = report({ max_error: 0.075, print_time_s: 250, uniform: { finest: uniform(9, 0.05, 400), coarsest: uniform(1, 0.3, 90) } });
  const picture = pictureOf(curve, { report: own });
  const xs = picture.dots.map(({ x }) => x);
  expect(xs).toEqual([...xs].sort((a, b) => a - b));
  expect(picture.own.x).toBeCloseTo(((xs[1] ?? 0) + (xs[2] ?? 0)) / 2);
  expect([picture.finest.x, picture.coarsest.x]).toEqual([xs[2], xs[0]]);
  expect(picture.finest.y).toBeLessThan(picture.own.y);
  expect(picture.coarsest.y).toBeGreaterThan(picture.own.y);
});
