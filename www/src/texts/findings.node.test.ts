import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import type { Code, Finding } from "../api/wire.js";
import { languageOf, LANGUAGES } from "./index.js";
import { findingsTexts, saidOf } from "./findings.js";

const finding = (code: Code): Finding => ({
  ...{ code, severity: "review", at_mm: [1, 2, 3], layers: [11, 16], area_mm2: 12.3456, volume_mm3: 7891.5, joins_layer: 1234, limit: 0.34 },
  bounds_mm: [
    [0, 0, 0],
    [1, 1, 1],
  ],
});

const CODES = Object.keys(findingsTexts(languageOf("en")).kinds) as Code[];

test.each(LANGUAGES)("every kind is a sentence with figures as the language writes them, and has advice: %s", (code) => {
  const language = languageOf(code);
  const words = findingsTexts(language);
  for (const kind of CODES) {
    const said = saidOf(finding(kind), language.format);
    const sentence = words.sentences[kind](said);
    expect(sentence).toMatch(/[.。]$/);
    expect(sentence).not.toMatch(/undefined|NaN|\[object/);
    expect([said.area, said.volume, said.resin].some((figure) => sentence.includes(figure)), sentence).toBe(true);
    expect(words.advice[kind]).toMatch(/[.。]$/);
    expect(words.kinds[kind]).not.toBe("");
  }
});

test("no two languages say the same, and no two kinds in one", () => {
  const all = LANGUAGES.map((code) => {
    const { format } = languageOf(code);
    const { sentences } = findingsTexts(languageOf(code));
    return CODES.map((kind) => sentences[kind](saidOf(finding(kind), format)));
  });
  expect(new Set(all.flat()).size).toBe(LANGUAGES.length * CODES.length);
});

test("in English the page says what the command line says", async () => {
  const source = await readFile(new URL("../../../src/inspect/finding.rs", import.meta.url), "utf8");
  const words = findingsTexts(languageOf("en"));
  // The core's sentences, with line continuations joined and figures removed.
  const bare = (text: string): string => text.toLowerCase().replaceAll("\u00a0", " ").replace(/[.;]$/u, "").replaceAll(/\s+/gu, " ");
  const core = [...source.replaceAll(/\\\n\s*/gu, "").matchAll(/"([^"\n]*; [^"\n]*)"/gu)].map(([, text = ""]) => bare(text.replaceAll(/\{[^}]*\}/gu, "#")));
  const figures = { area: "# mm²", volume: "# mm³", resin: "# ml", limit: "#", first: "#", joins: "#", layers: 2 };
  for (const kind of CODES) {
    const limit = /^(?:thin|narrow|low|small)-(?!contact)|overhang/u.test(kind) ? "# mm" : "#";
    const sentence = bare(words.sentences[kind]({ ...figures, limit })).replace("in 2 layers", "in # layers");
    expect(core).toContain(`${sentence}; ${bare(words.advice[kind])}`);
  }
  expect(core).toHaveLength(CODES.length);
});
