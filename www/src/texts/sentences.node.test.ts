/** Every code in every language, for the details and sentences recorded from the core. */
import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import type { ErrorCode, ErrorDetails } from "../api/error.js";
import type { WarningCode } from "../api/warning.js";
import { errors } from "./errors.js";
import { languageOf, LANGUAGES, type Format, type Language } from "./index.js";
import { errorOf } from "./problems.js";
import { warningOf, warnings } from "./warnings.js";

interface Sample {
  code: string;
  detail?: Record<string, unknown>;
  /** Sentence of the command line. */
  message: string;
}

const core = JSON.parse(await readFile(new URL("../../../tests/problems.json", import.meta.url), "utf8")) as {
  errors: Sample[];
  warnings: Sample[];
};

/** Errors raised only by the page. */
const OWN: { [Code in keyof ErrorDetails]?: ErrorDetails[Code] } = {
  "bad-attribute": { attribute: "metric", value: "beauty", known: ["cusp", "area"] },
  "no-model": null,
  "file-unreadable": null,
  "dropped-link": null,
  "folder-without-model": null,
  "printer-not-json": { system: "Unexpected end of JSON input" },
  "bad-source": { given: "Number" },
  "bad-facets": { list: "positions", numbers: 10, multiple_of: 9 },
  "bad-index": { place: 4, index: 8, vertices: 6 },
  "bad-number": { argument: "layer", value: "3" },
  "printer-too-long": { bytes: 3_000_000, most_bytes: 64_000 },
  "fetch-failed": { status: 404 },
  "worker-failed": { system: "https://cdn.test/worker.js could not be loaded" },
  "start-failed": { system: "no WebAssembly" },
  "part-failed": { part: "view", system: "404" },
  "no-browser": null,
  crash: { system: "unreachable" },
};

/** A sample, and one with the alternative of its optional best uniform layers. */
function bothCases(sample: Sample): Sample[] {
  const { detail } = sample;
  if (detail?.["best"] === undefined) return [sample];
  const best = detail["best"] === null ? { layer_mm: 0.0685, layers: 1882 } : null;
  return [sample, { ...sample, detail: { ...detail, best } }];
}

const own = Object.entries(OWN).map(([code, detail]) => ({ code, ...(detail !== null && { detail: detail as Record<string, unknown> }) }));

const errorIn = (language: Language, { code, detail }: Omit<Sample, "message">): string => errorOf(code as ErrorCode, (detail ?? null) as never, "cusp", language);
const warningIn = (language: Language, { code, detail }: Omit<Sample, "message">): string => warningOf(code as WarningCode, (detail ?? null) as never, language);

/** Details shown by offers, or not needed by readers. */
const UNSAID = ["least_tolerance", "largest_layer_min_mm", "planner"];
/** Fields that sentences say as words. */
const TRANSLATED = ["work", "replaced", "kind", "expected", "quantity", "fault", "feature", "metric", "unit", "stated", "given"];

/** Returns true if a sentence contains a number in the language's format, or a name unchanged. */
function says(sentence: string, value: unknown, format: Format): boolean {
  if (value === null) return true;
  if (typeof value === "object") return Object.entries(value).every(([key, item]) => TRANSLATED.includes(key) || says(sentence, item, format));
  if (typeof value !== "number") return sentence.includes(value as string);
  return [format.exact, format.bareHeight, format.tick].some((write) => sentence.includes(write(value)));
}

function check(sentence: string, detail: Record<string, unknown> | undefined, format: Format): void {
  expect(sentence).toMatch(/[.?!。？！）)]$/u);
  expect(sentence).not.toMatch(/undefined|NaN|\bnull\b|\[object/u);
  for (const [key, value] of Object.entries(detail ?? {})) {
    if (UNSAID.includes(key) || TRANSLATED.includes(key)) continue;
    expect(says(sentence, value, format), `${key}: ${String(value)} in: ${sentence}`).toBe(true);
  }
}

test("the core and the page together have every code and no other", () => {
  const codes = (samples: { code: string }[]): string[] => [...new Set(samples.map(({ code }) => code))].sort();
  expect(Object.keys(errors).sort()).toEqual(codes([...core.errors, ...own]));
  expect(Object.keys(warnings).sort()).toEqual(codes(core.warnings));
});

test.each(LANGUAGES)("every failure and warning is a sentence with its numbers: %s", (code) => {
  const language = languageOf(code);
  const failures = [...core.errors.flatMap(bothCases), ...own];
  for (const failure of failures) check(errorIn(language, failure), failure.detail, language.format);
  for (const warning of core.warnings.flatMap(bothCases)) check(warningIn(language, warning), warning.detail, language.format);
});

test("no two languages say the same", () => {
  for (const [samples, sentenceIn] of [[core.errors, errorIn], [core.warnings, warningIn]] as const) {
    for (const sample of samples) {
      const said = LANGUAGES.map((code) => sentenceIn(languageOf(code), sample));
      expect(new Set(said).size, sample.code).toBe(LANGUAGES.length);
    }
  }
});

/** A sentence without differences between page and command line: numbers, capitals and the full stop. */
const bare = (sentence: string): string =>
  sentence
    .toLowerCase()
    .replace(/[\d.,]*\d/gu, "#")
    .replaceAll("\u00a0", " ")
    .replace(/[[\]]/gu, "")
    .replace(/\.$/u, "");

test("in English the page says what the command line says", () => {
  const english = languageOf("en");
  for (const sample of core.errors) {
    const said = bare(errorIn(english, sample));
    const { code, message } = sample;
    // The offers show the fixes.
    if (code === "infeasible") expect(said).toContain("even a layer of # mm exceeds it");
    else expect(said).toBe(bare(message));
  }
  for (const sample of core.warnings) {
    const said = bare(warningIn(english, sample));
    const { code, message } = sample;
    // Only the command line names a command.
    if (code === "untried-thicknesses") expect(said).toContain(bare(message).split(";")[0]);
    else expect(said).toBe(bare(message));
  }
});
