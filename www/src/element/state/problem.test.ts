import { expect, test } from "vitest";
import { SlicerError, type ErrorCode, type ErrorDetails } from "../../api/error.js";
import type { Printer, Warning } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { advise, adviseOn } from "./advice.js";
import { explain as explainIn, type Failure } from "./problem.js";
import { check, DEFAULT_SETTINGS, type Settings } from "./settings.js";

const ENGLISH = languageOf("en");

function explain(
  error: SlicerError,
  name: string,
  settings: Settings,
  fixed: readonly (keyof Settings)[] = [],
  task: Failure["task"] = "plan",
): ReturnType<typeof explainIn> {
  return explainIn({ error, task, name, settings, height_mm: 60 }, ENGLISH, new Set(fixed));
}

const failed = <Code extends ErrorCode>(code: Code, detail: ErrorDetails[Code]): SlicerError =>
  // The element never shows the core's sentence.
  new SlicerError(code as "no-plan", "never shown", detail as null);

type Ways = Pick<ErrorDetails["infeasible"], "least_tolerance" | "largest_layer_min_mm">;

const infeasible = (ways: Ways): SlicerError =>
  failed("infeasible", { from_mm: 12.34, to_mm: 12.39, model_number: null, tolerance: 0.02, layer_min_mm: 0.05, ...ways });

const infeasibleAt = (patch: Partial<Settings>, detail: Ways): ReturnType<typeof explain> =>
  explain(infeasible(detail), "bunny.stl", { ...DEFAULT_SETTINGS, ...patch });

test("infeasible: where, and the core's two fixes, rounded so that they still work", () => {
  const problem = infeasibleAt({}, { least_tolerance: 0.0498731, largest_layer_min_mm: 0.02 });
  expect(problem.title).toBe("No plan keeps the tolerance all the way up");
  expect(problem.text).toBe(
    "No plan keeps every layer's error within 0.02\u00a0mm: from z = 12.34 to 12.39\u00a0mm even a layer of 0.05\u00a0mm exceeds it. " +
      "Raise the tolerance, or allow thinner layers if your printer can make them.",
  );
  expect(problem.offers).toEqual([
    { label: "Tolerance 0.05\u00a0mm", change: { tolerances: { cusp: "0.05" } } },
    { label: "Layers from 0.02\u00a0mm", change: { layerMin: "0.02" } },
  ]);
});

test("infeasible: only fixes that the core gives are offered", () => {
  const tolerance = infeasibleAt({}, { least_tolerance: 0.05, largest_layer_min_mm: null });
  expect(tolerance.offers.map(({ change }) => change)).toEqual([{ tolerances: { cusp: "0.05" } }]);
  expect(tolerance.text).toMatch(/Raise the tolerance\.$/);
  expect(infeasibleAt({}, { least_tolerance: null, largest_layer_min_mm: null }).offers).toEqual([]);
});

test.each([
  ["roughness", 0.0999271, "0.1", "Tolerance 0.1\u00a0mm"],
  ["area", 0.0712345, "7.13", "Tolerance 7.13%"],
  ["volume", 137.234, "138", "Tolerance 138\u00a0mm³"],
] as const)("infeasible by %s: the smallest tolerance in its unit, for that metric only", (metric, least, text, label) => {
  const problem = infeasibleAt(
    { metric, tolerances: { cusp: "0.05" } },
    { least_tolerance: least, largest_layer_min_mm: null },
  );
  expect(problem.offers).toEqual([{ label, change: { tolerances: { cusp: "0.05", [metric]: text } } }]);
});

test("thinner layers are offered exactly as the core found them", () => {
  const [offer] = infeasibleAt({ layerMin: "0.055" }, { least_tolerance: null, largest_layer_min_mm: 0.051 }).offers;
  expect(offer?.change).toEqual({ layerMin: "0.051" });
});

test("layers that do not add up: thinner ones may", () => {
  const problem = explain(failed("layers-do-not-fit", { from_mm: 0, to_mm: 1, layer_min_mm: 0.3, layer_max_mm: 0.4 }), "a.stl", DEFAULT_SETTINGS);
  expect(problem.offers.map(({ change }) => change)).toEqual([{ layerMin: "0.025" }]);
});

test("a heading, and under it the catalogue's sentence with its figures", () => {
  const error = failed("stl-truncated", { declared_facets: 1200, expected_bytes: 60_084, found_bytes: 90 });
  const problem = explain(error, "a.stl", DEFAULT_SETTINGS);
  expect(problem.title).toBe("a.stl is cut short");
  expect(problem.text).toBe(
    "The STL is cut short: its header announces 1,200 facets, which need 60,084 bytes, but the file ends at byte 90; copy or export it again.",
  );
});

test.each([
  [failed("no-hits", { pitch_mm: 1 }), "a.stl is too thin for these pixels"],
  [failed("all-black", null), "Every layer would be empty"],
  [failed("layer-too-thick", { layer_mm: 2, height_mm: 1 }), "The layers are too thick for this model"],
  [failed("layer-range-empty", { layer_min_mm: 1, layer_max_mm: 2, step_mm: 3 }), "No layer of whole motor steps lies in this range"],
  [failed("gpu-too-small", { facets: 3, needed_bytes: 2, limit_bytes: 1 }), "The GPU is too small for this model"],
  [failed("out-of-reach", { layers: 1, least_layers: 2 }), "No plan meets this limit"],
])("%s has a heading of its own", (error, title) => {
  expect(explain(error, "a.stl", DEFAULT_SETTINGS).title).toBe(title);
});

/** A model that fits at about half its size. */
const TOO_LARGE = failed("model-too-large", { model_mm_x: 2, model_mm_y: 2, grid_mm_x: 1.0024, grid_mm_y: 2, fitting_scale: 0.5012 });
const BEST = { layer_mm: 0.068, layers: 882 };
const BEST_OFFER = { label: "Uniform layers of 0.068\u00a0mm (882 layers)", change: { planner: "uniform", uniform: "0.068" } };
const uniformOnly = (best: typeof BEST | undefined): SlicerError =>
  failed("uniform-only", { format: "sl1", others: ["goo", "ctb", "chitubox", "uvj", "png"], best });

test("out of memory offers half the rays, down to the minimum", () => {
  const error = failed("out-of-memory", { hits: 1, needed_bytes: 8 });
  expect(explain(error, "a.stl", DEFAULT_SETTINGS).offers[0]?.change).toEqual({ rays: "1024" });
  expect(explain(error, "a.stl", { ...DEFAULT_SETTINGS, rays: "512" }).offers).toEqual([]);
});

test("a model that is too large offers to scale it to fit, or to leave out the printer", () => {
  const problem = explain(TOO_LARGE, "a.stl", { ...DEFAULT_SETTINGS, printer: "p" });
  expect(problem.field).toBe("printer");
  expect(problem.offers).toEqual([
    { label: "Scale to 30\u00a0mm", change: { height: "30" } },
    { label: "Without a printer", change: { printer: "" } },
  ]);
});

test("no offer changes what the page has fixed", () => {
  const { offers } = explain(TOO_LARGE, "a.stl", { ...DEFAULT_SETTINGS, printer: "p" }, ["printer", "format"]);
  expect(offers).toEqual([{ label: "Scale to 30\u00a0mm", change: { height: "30" } }]);
  expect(explain(uniformOnly(BEST), "a.stl", DEFAULT_SETTINGS, ["format"]).offers).toEqual([BEST_OFFER]);

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
  expect(larger?.text).toMatch(/Raise the tolerance\.$/);
  expect(none?.text).toMatch(/exceeds it\.$/);
});

test("a format for uniform layers offers the best of those, or another format", () => {
  const { field, offers } = explain(uniformOnly(BEST), "a.stl", { ...DEFAULT_SETTINGS, format: "sl1" });
  expect(field).toBe("format");
  expect(offers).toEqual([BEST_OFFER, { label: "Save as images", change: { format: "png" } }]);
});

test("a printer for uniform layers offers the best of those", () => {
  const error = failed("printer-uniform-only", { model: "Anycubic Photon M3", best: { layer_mm: 0.1 + 0.02, layers: 500 } });
  const { field, offers } = explain(error, "a.stl", { ...DEFAULT_SETTINGS, printer: "photon-m3" });
  expect(field).toBe("printer");
  expect(offers).toEqual([{ label: "Uniform layers of 0.12\u00a0mm (500 layers)", change: { planner: "uniform", uniform: "0.12" } }]);
});

test("if no uniform layers keep the tolerance, those of the thickness in the form are offered", () => {
  const [offer] = explain(uniformOnly(undefined), "a.stl", { ...DEFAULT_SETTINGS, uniform: "0.04" }).offers;
  expect(offer).toEqual({ label: "Uniform layers of 0.04\u00a0mm", change: { planner: "uniform" } });
});

test("an unknown printer offers the three most similar names, or none", () => {
  const error = failed("unknown-printer", { printer: "saturn-5", similar: ["saturn", "saturn-4", "saturn-2", "saturn-3"], known: 110 });
  const { title, field, offers } = explain(error, "a.stl", { ...DEFAULT_SETTINGS, printer: "saturn-5" });
  expect([title, field]).toEqual(["There is no such printer", "printer"]);
  expect(offers.map(({ change }) => change.printer)).toEqual(["saturn", "saturn-4", "saturn-2", ""]);
});

test("a printer whose description is wrong is blamed, and may be left out; a file that is refused changed nothing", () => {
  const bad = explain(failed("bad-printer", { printer: "mine", field: "pitch_um" }), "a.stl", { ...DEFAULT_SETTINGS, printer: "mine" });
  expect(bad).toMatchObject({ field: "printer", offers: [{ change: { printer: "" } }] });
  expect(bad.text).toBe("The description of the printer mine has an invalid pitch_um; correct it.");
  // Nothing else that the form gives can be unreadable.
  const own = { pixels: [1, 1] } as unknown as Printer;
  const system = "Failed to deserialize JsValue into type `cusp_slicer::job::options::Options`: Error: missing field `pitch_um`";
  const missing = explain(failed("bad-options", { system }), "a.stl", { ...DEFAULT_SETTINGS, printer: own });
  expect(missing).toMatchObject({ title: bad.title, field: "printer", text: "The options cannot be read: missing field `pitch_um`." });
  for (const error of [
    failed("printer-not-json", { system: "Unexpected end of JSON input" }),
    failed("printer-too-long", { bytes: 3_000_000, most_bytes: 64_000 }),
    failed("bad-printer", { printer: "mine", field: "pitch_um" }),
  ]) {
    expect(explain(error, "mine.json", DEFAULT_SETTINGS, [], null)).toMatchObject({ title: bad.title, field: "printer", offers: [] });
  }
});

test.each([
  ["step", "This is a STEP file, which Cusp does not read; export the model as STL, 3MF or OBJ."],
  ["gzip", "This is a gzip file, which Cusp does not read; unpack it, and open the model inside."],
  ["html", "This is a HTML file, which Cusp does not read; download the model itself; the address may need a login, or lead to a page about the model."],
] as const)("a file of another kind is named: %s", (kind, text) => {
  const problem = explain(failed("other-file-kind", { kind }), "a", DEFAULT_SETTINGS);
  expect(problem.title).toBe("a could not be opened");
  expect(problem.text).toBe(text);
});

test("warnings are sentences with their figures", () => {
  const metric = "cusp";
  const words = (warning: Warning): string | undefined => advise([warning], languageOf("en"), new Set())[0]?.text;
  expect(words({ code: "inside-out" })).toBe("The mesh was inside out, and was turned over.");
  expect(words({ code: "degenerate-facets", detail: { facets: 1 } })).toBe("Left out 1 facet without area.");
  expect(words({ code: "tolerance-exceeded", detail: { planner: "uniform", metric, tolerance: 0.05, max_error: 0.0712 } })).toBe(
    "The error reaches 0.071\u00a0mm, more than the tolerance of 0.05\u00a0mm.",
  );
  expect(words({ code: "black-layers", detail: { layers: 64, from_mm: 1 } })).toMatch(/^64 layers of the plan are black, from 1\.000\u00a0mm up/);
});

test("a warning about several models is said once, with their names", () => {
  const open: Warning = { code: "open-mesh", detail: { open_edges: 3, holes: 1 } };
  const inside: Warning = { code: "inside-out" };
  const of = [
    { name: "a.stl", warnings: [inside] },
    { name: "b.stl", warnings: [open, inside, inside] },
    { name: null, warnings: [{ code: "black-layers", detail: { layers: 64, from_mm: 1 } }] },
  ] as const;
  const said = adviseOn(of, languageOf("en"), new Set());
  expect(said.map(({ text, names }) => [text.slice(0, 8), ...names])).toEqual([["The mesh", "a.stl", "b.stl"], [expect.any(String), "b.stl"], ["64 layer"]]);
  expect(languageOf("en").format.all(["a.stl", "b.stl"])).toBe("a.stl and b.stl");
});

test("a warning is said once, and offers what keeps the tolerance in layers of one thickness", () => {
  const warn = (warnings: readonly Warning[], fixed: readonly (keyof Settings)[] = []): ReturnType<typeof advise> =>
    advise(warnings, languageOf("en"), new Set(fixed));
  const one: Warning = { code: "one-thickness", detail: { taker: "Anycubic Photon M3", best: BEST } };
  const text =
    "Anycubic Photon M3 takes one thickness for all layers, and this plan has several; 882 uniform layers of 0.068\u00a0mm keep the tolerance.";
  expect(warn([one, { code: "inside-out" }, one])).toEqual([
    { text, offers: [BEST_OFFER], towers: true, plates: null, parts: false },
    { text: "The mesh was inside out, and was turned over.", offers: [], towers: false, plates: null, parts: false },
  ]);
  expect(warn([one], ["uniform"])).toEqual([{ text, offers: [], towers: true, plates: null, parts: false }]);
  expect(warn([{ code: "one-thickness", detail: { taker: "sl1", best: null } }])).toEqual([
    { text: "sl1 takes one thickness for all layers, and this plan has several; choose the uniform planner.", offers: [], towers: false, plates: null, parts: false },
  ]);
});

test("test towers are offered where the printer decides, not the format, and not for a printer that the page has fixed", () => {
  const taken = (taker: string): Warning => ({ code: "one-thickness", detail: { taker, best: null } });
  const towers = (warning: Warning, fixed: readonly (keyof Settings)[] = []): boolean[] =>
    advise([warning], languageOf("en"), new Set(fixed)).map((advice) => advice.towers);
  expect(towers({ code: "untried-thicknesses", detail: { model: "Elegoo Saturn 3" } })).toEqual([true]);
  expect(towers(taken("Anycubic Photon M3"))).toEqual([true]);
  expect(towers(taken("Anycubic Photon M3"), ["printer"])).toEqual([false]);
  expect(towers(taken("sl1"))).toEqual([false]);
});

test("where a size is odd, the units that make it usual are offered", () => {
  const readings = [
    { unit: "inch", size_mm: 20.32 },
    { unit: "centimeter", size_mm: 8 },
  ] as const;
  const odd: Warning = { code: "odd-size", detail: { size_mm: 0.8, readings: [...readings] } };
  const [advice] = advise([odd], languageOf("en"), new Set());
  expect(advice?.offers).toEqual([
    { label: "It is in inches", change: { unit: "inch" } },
    { label: "It is in centimeters", change: { unit: "centimeter" } },
  ]);
  expect(advise([odd], languageOf("en"), new Set(["unit"]))[0]?.offers).toEqual([]);
});

test("a format that cannot hold test towers offers no other settings for them", () => {
  const failure = { error: uniformOnly(undefined), task: "towers", name: "", settings: DEFAULT_SETTINGS, height_mm: 60 } as const;
  const problem = explainIn(failure, ENGLISH, new Set());
  expect(problem).toMatchObject({ title: "This print file takes uniform layers only", field: "format", offers: [] });
});

test("a print file with floating pieces can be saved all the same", () => {
  const error = failed("floating-pieces", { pieces: 2, volume_mm3: 3.25, layer_number: 41, at_mm: [1.5, -2, 2.05] });
  const problem = explain(error, "ball.stl", { ...DEFAULT_SETTINGS, supports: "light" });
  expect(problem).toMatchObject({ title: "Pieces of the print would float in the vat", field: "supports" });
  expect(problem.offers).toEqual([{ label: "Save it all the same", change: { floating: "allow" } }]);
  const settled = check({ ...DEFAULT_SETTINGS, supports: "light", floating: "allow" });
  expect(settled).toMatchObject({ ok: true, options: { allow_floating: true } });
});

test("of a project with several plates another can be chosen", () => {
  const detail = { plate_number: 2, plates: 3 };
  expect(advise([{ code: "other-plates", detail }], languageOf("en"), new Set())).toEqual([{ text: "Plate 2 of 3 is read.", offers: [], towers: false, plates: detail, parts: false }]);
});

test("whether a printer that the page has fixed was ever tried is not the customer's business", () => {
  const untried: Warning = { code: "untried-thicknesses", detail: { model: "Elegoo Saturn 3" } };
  expect(advise([untried], languageOf("en"), new Set())).toEqual([
    { text: expect.stringMatching(/^It is not confirmed that the Elegoo Saturn 3 .*print the test towers, or/), offers: [], towers: true, plates: null, parts: false },
  ]);
  expect(advise([untried], languageOf("en"), new Set(["printer"]))).toEqual([]);
});

test("a name from outside cannot turn its line around", () => {
  const problem = explain(failed("no-hits", { pitch_mm: 1 }), "cat\u202egnp.stl\n", DEFAULT_SETTINGS);
  expect(problem.title).toContain("cat\\u{202e}gnp.stl\\u{a}");
});
