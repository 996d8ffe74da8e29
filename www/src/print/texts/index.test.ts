import { expect, test } from "vitest";
import { LANGUAGES, languageOf } from "../../texts/index.js";
import { textsOf } from "./index.js";

test.each(LANGUAGES)("a fault is named within its sentence: %s", (code) => {
  const { finding, error } = textsOf(languageOf(code));
  const fault = { code: "wrong-checksum", detail: { stated: 17, computed: 99 } } as const;
  for (const sentence of [
    finding({ code: "bad-layers", detail: { layers: 2, first_layer: 5, fault } }),
    error({ code: "layer", detail: { layer: 5, fault } }),
  ]) {
    expect(sentence).toMatch(/5.*17.*99/);
  }
});

test("a code that the catalogue does not know is said as it is", () => {
  const { error } = textsOf(languageOf("en"));
  expect(error({ code: "from-tomorrow" } as never)).toBe("from-tomorrow");
});

test("numbers are those of the language", () => {
  const detail = { needed_bytes: 1_234_567, found_bytes: 12 };
  expect(textsOf(languageOf("de-AT")).error({ code: "truncated", detail })).toMatch(/1.234.567 Byte/);
  expect(textsOf(languageOf("en")).error({ code: "truncated", detail })).toContain("1,234,567 bytes");
});
