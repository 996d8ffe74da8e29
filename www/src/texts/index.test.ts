import { expect, test } from "vitest";
import { languageOf } from "./index.js";

const { format } = languageOf("en");

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

test("a language is the first with a dictionary, with the numbers of its country", () => {
  expect(languageOf("tlh", "de-CH").locale).toBe("de-CH");
  expect(languageOf("not a locale").locale).toBe("en");
  // Locales that browsers report if the system has none.
  for (const locale of ["C", "POSIX", "en-US@posix", "de_DE.UTF-8", ""]) {
    expect(languageOf(locale).format.size(1.5)).toBe("1.5");
    expect(languageOf(locale, "fr").locale).toBe("fr");
  }
  expect(languageOf("de").format.size(1234.5)).toBe("1.234,5");
  expect(languageOf("fr").texts.plan.layers({ count: 1 })).toBe("couche");
  expect(languageOf("fr").texts.plan.layers({ count: 2 })).toBe("couches");
  expect(languageOf("zh").format.time(3600)).toBe("1\u00a0小时\u00a00\u00a0分钟");
});
