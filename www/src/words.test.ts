import { expect, test } from "vitest";
import { archiveName, choose } from "./choice.js";
import { rows, sentence } from "./comparison.js";
import * as format from "./format.js";
import { explain } from "./problem.js";
import { standing } from "./progress.js";
import { DEFAULT_SETTINGS } from "./settings.js";
import type { Report } from "./wire.js";

const limits = [0.05, 0.15] as const;

function report(patch: Partial<Report>): Report {
  return {
    layers: 793,
    height_mm: 60,
    z_mm: [],
    thickness_mm: [],
    max_error_mm: 0.065,
    tolerance_mm: 0.065,
    metric: "cusp",
    planner: "optimal",
    backend: "cpu",
    adapter: null,
    bins: 30_000,
    bin_mm: 0.002,
    facets: 69_451,
    hits: 5_218_540,
    uniform: { finest_layers: 1200, finest_error_mm: 0.05, coarsest_layers: 400, coarsest_error_mm: 0.15 },
    mask: { width: 2048, height: 1588, pitch_mm: 0.0293 },
    warnings: [],
    timings_ms: { load: 0, ldi: 0, profile: 0, plan: 0, masks: 0, total: 0 },
    ...patch,
  };
}

test("the gain over the finest uniform plan", () => {
  expect(sentence(report({}), limits)).toBe("34% fewer than uniform 0.05\u00a0mm (1,200), same tolerance.");
});

test("a plan that gains nothing says so", () => {
  expect(sentence(report({ layers: 1200 }), limits)).toMatch(/^As many as uniform 0.05/);
});

test("a plan as short as the coarsest, where that holds", () => {
  const uniform = { finest_layers: 1200, finest_error_mm: 0.01, coarsest_layers: 400, coarsest_error_mm: 0.03 };
  expect(sentence(report({ layers: 400, uniform }), limits)).toMatch(/^As few as uniform 0.15/);
});

test("a uniform plan over the tolerance says by how much", () => {
  expect(sentence(report({ planner: "uniform", max_error_mm: 0.1 }), limits)).toMatch(/reaches 0.1\u00a0mm, more than the 0.065/);
});

test("the coarsest row says that it breaks the tolerance; rounding of sums does not count", () => {
  expect(rows(report({ max_error_mm: 0.0650000001 }), limits).map(({ holds }) => holds)).toEqual([true, true, false]);
});

test("infeasible: where, and two ways out that differ from what is set", () => {
  const problem = explain(
    { code: "infeasible", message: "no plan", detail: { height_mm: 12.34 } },
    "bunny.stl",
    { ...DEFAULT_SETTINGS, tolerance: "0.02" },
  );
  expect(problem.title).toBe("No plan keeps 0.02\u00a0mm, at a height of 12.340\u00a0mm");
  expect(problem.offers.map(({ change }) => change)).toEqual([{ tolerance: "0.05" }, { layerMin: "0.02" }]);
});

test("infeasible although the tolerance is the thinnest layer: more room all the same", () => {
  const problem = explain({ code: "infeasible", message: "", detail: null }, "a.stl", { ...DEFAULT_SETTINGS, tolerance: "0.05" });
  expect(problem.offers.map(({ change }) => change)).toEqual([{ tolerance: "0.063" }, { layerMin: "0.025" }]);
});

test("the core's message becomes a sentence under our heading", () => {
  const problem = explain({ code: "stl-truncated", message: "the file ends at byte 90", detail: null }, "a.stl", DEFAULT_SETTINGS);
  expect(problem.title).toBe("a.stl is cut short");
  expect(problem.text).toBe("The file ends at byte 90.");
});

test.each([
  ["no-hits", "a.stl is too thin for these pixels"],
  ["all-black", "Every mask would be black"],
  ["layer-too-thick", "The layers are too thick for this model"],
])("%s has a heading of its own", (code, title) => {
  expect(explain({ code, message: "x", detail: null }, "a.stl", DEFAULT_SETTINGS).title).toBe(title);
});

test("out of memory offers half the rays, down to the least there is", () => {
  const error = { code: "out-of-memory", message: "too much", detail: null };
  expect(explain(error, "a.stl", DEFAULT_SETTINGS).offers[0]?.change).toEqual({ rays: "1024" });
  expect(explain(error, "a.stl", { ...DEFAULT_SETTINGS, rays: "512" }).offers).toEqual([]);
});

test("a code that the page has never heard of still shows the core's words", () => {
  expect(explain({ code: "new", message: "odd", detail: null }, "a.stl", DEFAULT_SETTINGS).text).toBe("Odd.");
});

test.each([
  [[], { kind: "none" }],
  [["a.txt"], { kind: "not-stl", name: "a.txt" }],
  [["A.STL"], { kind: "file", file: { name: "A.STL" }, notice: null }],
  [["model"], { kind: "file", file: { name: "model" }, notice: null }],
  [
    ["notes.txt", "b.stl", "c.stl"],
    { kind: "file", file: { name: "b.stl" }, notice: "3 files came at once. Cusp takes one at a time: this is b.stl." },
  ],
])("of %j the first STL is taken", (names, choice) => {
  expect(choose(names.map((name) => ({ name })))).toEqual(choice);
});

test("the zip is named after the model", () => {
  expect(archiveName("bunny.stl")).toBe("bunny-cusp.zip");
  expect(archiveName("part.v2.STL")).toBe("part.v2-cusp.zip");
  expect(archiveName(".stl")).toBe("model-cusp.zip");
});

test("numbers as people read them", () => {
  expect(format.duration(0.2)).toBe("< 1\u00a0ms");
  expect(format.duration(412.4)).toBe("412\u00a0ms");
  expect(format.duration(1340)).toBe("1.3\u00a0s");
  expect(format.dimensions([60, 46.52, 59.4])).toBe("60.0 × 46.5 × 59.4\u00a0mm");
});

test("progress never runs backwards over the stages of a plan, and a download counts its own", () => {
  const at = (stage: "load" | "ldi" | "profile" | "plan" | "masks", task: "plan" | "archive"): number =>
    standing({ task, name: "", stage, fraction: 0.5 }).done;
  expect([at("load", "plan"), at("ldi", "plan"), at("profile", "plan"), at("plan", "plan")]).toEqual([0.125, 0.375, 0.625, 0.875]);
  expect(at("masks", "archive")).toBe(0.5);
  expect(at("ldi", "archive")).toBe(0);
});
