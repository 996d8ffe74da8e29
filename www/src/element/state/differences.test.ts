import { expect, test } from "vitest";
import { languageOf, LANGUAGES } from "../../texts/index.js";
import { orientationTexts } from "../../texts/orientation.js";
import { differences, figure, type Metrics } from "./differences.js";
import { AIMS, type Aims } from "./orientation.js";

const now: Metrics = { layers: 1200, print_time_s: 7200, max_error: 0.06, roughness_mm: 0.0123, overhang_mm2: 50, islands: 0, cups_mm2: 0, support_ml: 0, contact_mm2: 0 };
const en = languageOf("en");

const NONE = Object.fromEntries(Object.keys(AIMS.ranking).map((term) => [term, 0])) as Aims["ranking"];

const words = (patch: Partial<Metrics>, ranking: Partial<Aims["ranking"]>): string[] => differences({ ...now, ...patch }, now, { ...NONE, ...ranking }, "cusp", en);

test("what counts is compared, the most important first", () => {
  const other = { layers: 840, overhang_mm2: 610.2, islands: 3, cups_mm2: 12.3, print_time_s: 3600, roughness_mm: 0.02 };
  expect(words(other, { layers: 1, overhang: 2 })).toEqual(["560\u00a0mm² more overhang", "360 layers fewer"]);
  expect(words({ layers: 1201, overhang_mm2: 0 }, { layers: 1, overhang: 1 })).toEqual(["1 layer more", "50\u00a0mm² less overhang"]);
  expect(words(other, { islands: 3 })).toEqual(["3 islands more"]);
  expect(words(other, { cups: 1 })).toEqual(["12\u00a0mm² more suction area"]);
  expect(words(other, { time: 2, roughness: 1 })).toEqual(["1\u00a0h\u00a00\u00a0min quicker", "7.7\u00a0µm rougher"]);
  // Four at most.
  expect(words(other, { islands: 3, cups: 3, overhang: 2, layers: 2, time: 1 })).toHaveLength(4);
});

test("what reads the same is no difference", () => {
  const all = { layers: 1, time: 1, error: 1, overhang: 1 };
  expect(words({}, all)).toEqual([]);
  expect(words({ max_error: 0.0604, overhang_mm2: 50.4 }, all)).toEqual([]);
  // On either side of a rounding boundary, but less than one unit of the last digit apart.
  expect(words({ max_error: 0.0596, overhang_mm2: 49.4, print_time_s: 7169 }, all)).toEqual(["1\u00a0min quicker", "1\u00a0mm² less overhang"]);
  expect(words({ print_time_s: 7181 }, all)).toEqual([]);
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
