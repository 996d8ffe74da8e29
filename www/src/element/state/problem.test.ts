import { expect, test } from "vitest";
import { SlicerError, ERROR_CODES, type ErrorCode } from "../../api/error.js";
import { WARNING_CODES } from "../../api/warning.js";
import type { Warning } from "../../api/wire.js";
import { languageOf, LANGUAGES } from "../../texts/index.js";
import { explain as explainIn, warningWords } from "./problem.js";
import { check, DEFAULT_SETTINGS, type Settings } from "./settings.js";

function explain(
  error: SlicerError,
  name: string,
  settings: Settings,
  fixed: readonly (keyof Settings)[] = [],
): ReturnType<typeof explainIn> {
  return explainIn({ error, name, settings, height_mm: 60 }, languageOf("en"), new Set(fixed));
}

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

test("thinner layers are offered as the core has found them", () => {
  const [offer] = infeasibleAt({ layerMin: "0.055" }, { least_tolerance: null, largest_layer_min_mm: 0.051 }).offers;
  expect(offer?.change).toEqual({ layerMin: "0.051" });
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
