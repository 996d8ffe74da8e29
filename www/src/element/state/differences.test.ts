import { expect, test } from "vitest";
import { languageOf, LANGUAGES } from "../../texts/index.js";
import { orientationTexts } from "../../texts/orientation.js";
import { differences, figure, type Metrics } from "./differences.js";
import { DEFAULT_AIMS } from "./orientation.js";

const now: Metrics = { layers: 1200, print_time_s: 7200, max_error: 0.06, roughness_mm: 0.0123, overhang_mm2: 50, islands: 0, cups_mm2: 0, support_ml: 0, contact_mm2: 0 };
const en = languageOf("en");

const words = (patch: Partial<Metrics>, aims: Partial<Parameters<typeof differences>[2]> = {}): string[] =>
  differences({ ...now, ...patch }, now, { ...DEFAULT_AIMS, ...aims }, "cusp", en);

test("a pose has fewer or more layers, and more or less overhang, than the one now", () => {
  expect(words({ layers: 840, overhang_mm2: 610.2 })).toEqual(["360 layers fewer", "560\u00a0mm² more overhang"]);
  expect(words({ layers: 1201, overhang_mm2: 0 })).toEqual(["1 layer more", "50\u00a0mm² less overhang"]);
});

test("islands and cups are compared where they are the aim", () => {
  const other = { layers: 1200, islands: 3, cups_mm2: 12.3 };
  expect(words(other)).toEqual(["Same number of layers"]);
  expect(words(other, { quality: "islands" })).toEqual(["Same number of layers", "3 islands more"]);
  expect(words(other, { quality: "cups" })).toEqual(["Same number of layers", "12\u00a0mm² more suction area"]);
});

test("the chosen cost and quality decide what is compared", () => {
  const other = { layers: 840, print_time_s: 3600, max_error: 0.05, roughness_mm: 0.02 };
  expect(words(other)).toEqual(["360 layers fewer", "Largest step: 0.01\u00a0mm smaller"]);
  expect(words(other, { cost: "time", quality: "roughness" })).toEqual(["1\u00a0h\u00a00\u00a0min quicker", "7.7\u00a0µm rougher"]);
  expect(words({ ...other, overhang_mm2: 51 }, { quality: "overhang" })).toEqual(["360 layers fewer", "1\u00a0mm² more overhang"]);
});

test("what reads the same is no difference, and only the cost is said to be the same", () => {
  expect(words({})).toEqual(["Same number of layers"]);
  expect(words({ max_error: 0.0604, overhang_mm2: 50.4 })).toEqual(["Same number of layers"]);
  // On either side of a rounding boundary, but less than one unit of the last digit apart.
  expect(words({ max_error: 0.0596, overhang_mm2: 49.4, print_time_s: 7169 }, { cost: "time" })).toEqual(["1\u00a0min quicker", "1\u00a0mm² less overhang"]);
  expect(words({ print_time_s: 7181 }, { cost: "time" })).toEqual(["Same print time"]);
});

test("every language says which is less", () => {
  for (const code of LANGUAGES) {
    const { texts } = languageOf(code);
    const { differs } = orientationTexts(languageOf(code));
    const pairs = (["less", "more"] as const).map((way) => [
      differs.layers[way]({ count: 12 }),
      differs.time[way]({ amount: "5 min" }),
      differs.error[way]({ head: texts.metrics.cusp.head, amount: "0.01 mm" }),
      differs.roughness[way]({ amount: "2 µm" }),
      differs.overhang[way]({ amount: "30 mm²" }),
    ]);
    const [less = [], more = []] = pairs;
    for (const [i, it] of less.entries()) expect(it, code).not.toBe(more[i]);
    expect(less.map((it) => /12|5 min|0\.01 mm|2 µm|30 mm²/.test(it))).toEqual([true, true, true, true, true]);
  }
});

test("a figure has the unit of its term, and an error that of its metric", () => {
  expect(figure("roughness", now, "cusp", en)).toBe("12.3\u00a0µm");
  expect(figure("overhang", { ...now, overhang_mm2: 1234.4 }, "cusp", en)).toBe("1,234\u00a0mm²");
  expect(figure("error", now, "area", en)).toBe("6%");
});
