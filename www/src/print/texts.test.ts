import { expect, test } from "vitest";
import { LANGUAGES, languageOf } from "../texts/index.js";
import { failureOf, findingOf } from "./texts.js";

test.each(LANGUAGES)("a fault is named within its sentence: %s", (code) => {
  const language = languageOf(code);
  const fault = { code: "wrong-checksum", detail: { stated: 17, computed: 99 } } as const;
  for (const sentence of [
    findingOf({ code: "bad-layers", detail: { layers: 2, first_layer: 5, fault } }, language),
    failureOf({ code: "layer", detail: { layer: 5, fault } }, language),
  ]) {
    expect(sentence).toMatch(/5.*17.*99/);
  }
});

test("a code without a sentence is said as it is", () => {
  expect(failureOf({ code: "from-tomorrow" } as never, languageOf("en"))).toBe("from-tomorrow");
});

test("numbers are those of the language", () => {
  const detail = { needed_bytes: 1_234_567, found_bytes: 12 };
  expect(failureOf({ code: "truncated", detail }, languageOf("de-AT"))).toMatch(/1.234.567 Byte/);
  expect(failureOf({ code: "truncated", detail }, languageOf("en"))).toContain("1,234,567 bytes");
});
