import { expect, test } from "vitest";
import { languageOf, LANGUAGES } from "./index.js";
import { paintingTexts } from "./painting.js";
import { viewingTexts } from "./viewing.js";
import { placingTexts } from "./placing.js";

test.each(LANGUAGES)("every sentence ends, and the selected one is told by its number and height: %s", (code) => {
  const { points, drains } = placingTexts(languageOf(code));
  for (const words of [points, drains]) {
    expect(words.hint).toMatch(/[.。]$/);
    expect(words.lockHint).toMatch(/[.。]$/);
    const said = words.selected({ number: "3", all: "46", height: "12.3 mm" });
    for (const figure of ["3", "46", "12.3 mm"]) expect(said).toContain(figure);
  }
});

test("no two languages say the same", () => {
  const all = LANGUAGES.flatMap((code) => {
    const { points, drains, automatically } = placingTexts(languageOf(code));
    return [points.hint, drains.hint, automatically, paintingTexts(languageOf(code)).hint];
  });
  expect(new Set(all).size).toBe(4 * LANGUAGES.length);
});

test.each(LANGUAGES)("the panels are named as their tools are: %s", (code) => {
  const language = languageOf(code);
  const { hints } = viewingTexts(language);
  expect(placingTexts(language).points.title).toBe(hints.supports);
  expect(placingTexts(language).drains.title).toBe(hints.drains);
  expect(paintingTexts(language).title).toBe(hints.paint);
});
