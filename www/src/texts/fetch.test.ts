import { expect, test, vi } from "vitest";

test("a language is English until it is fetched, and nothing is fetched twice", async () => {
  vi.resetModules();
  const { fetchLanguage, languageOf } = await import("./index.js");
  expect(fetchLanguage("en-GB")).toBeNull();
  expect(languageOf("de-AT").locale).toBe("en");
  const [once, twice] = [fetchLanguage("tlh", "de-AT"), fetchLanguage("de")];
  expect(once).toBe(twice);
  await once;
  expect(languageOf("de-AT")).toMatchObject({ code: "de", locale: "de-AT" });
  expect(languageOf("de-AT").texts.plan.layers({ count: 2 })).toBe("Schichten");
  expect(fetchLanguage("de")).toBeNull();
  expect(languageOf("fr").locale).toBe("en");
});
