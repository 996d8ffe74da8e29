import { expect, test } from "vitest";
import type { Options, Report } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { enough, rows, sentence as sentenceIn, type Compared } from "./comparison.js";
import { report, uniforms } from "./report-fixture.js";

const sentence = (compared: Compared): string => sentenceIn(compared, languageOf("en"));

const limits = [0.05, 0.15] as const;

const compared = (patch: Partial<Report>, options: Options = {}): Compared => ({ report: report(patch), limits, options });

test("the gain over the best uniform layers within tolerance, in layers or in time", () => {
  expect(sentence(compared({}))).toBe("14% fewer than the best uniform layers within tolerance (923 of 0.065\u00a0mm).");
  const inTime = "12% less time than the quickest uniform layers within tolerance (0.065\u00a0mm, 2\u00a0h\u00a050\u00a0min).";
  expect(sentence(compared({}, { minimize: "time" }))).toBe(inTime);
  expect(sentenceIn(compared({}), languageOf("en"), "time")).toBe(inTime);
});

test("where uniform layers are enough, the sentence says so, and they are offered", () => {
  const cube = compared({ layers: 915, uniform: uniforms({ is_enough: true }) });
  expect(sentence(cube)).toMatch(/^Uniform layers of 0.065\u00a0mm \(923\) do about as well within 0.065/);
  expect(enough(cube)?.layers).toBe(923);
  expect(enough(compared({}))).toBeNull();
  // The plan has more layers than the uniform one, since flats require some.
  expect(sentenceIn(compared({ print_time_s: 10_300 }), languageOf("en"), "time")).toMatch(/^Uniform layers of 0.065/);
});

test("where no uniform layers keep the tolerance, the sentence says so", () => {
  const alone = compared({ uniform: uniforms({ fewest: null, quickest: null }) });
  expect(sentence(alone)).toBe("No uniform layers from 0.05\u00a0mm to 0.15\u00a0mm stay within 0.065\u00a0mm; these do.");
  expect(rows(alone).map(({ kind }) => kind)).toEqual(["finest", "own", "coarsest"]);
});

test("the best uniform layers have a row of their own, or that of the end that they are", () => {
  expect(rows(compared({})).map(({ kind, uniform_mm }) => [kind, uniform_mm])).toEqual([
    ["finest", 0.05],
    ["best", 0.065],
    ["own", null],
    ["coarsest", 0.15],
  ]);
  const coarsest = { layer_mm: 0.15, layers: 400, max_error: 0.03, print_time_s: 5_538 };
  const steep = compared({ uniform: uniforms({ fewest: coarsest }) });
  expect(rows(steep).map(({ kind }) => kind)).toEqual(["finest", "best", "own"]);
});

test("a uniform plan over the tolerance says by how much, in the unit of its metric", () => {
  const over = { planner: "uniform", max_error: 0.1 };
  expect(sentence(compared(over))).toMatch(/^The largest step is 0.1\u00a0mm, more than the 0.065/);
  expect(sentence(compared({ ...over, metric: "area" }))).toBe("The area deviation is 10%, more than the 6.5% allowed.");
  expect(sentence(compared({ ...over, metric: "volume", max_error: 11.26 }))).toMatch(/^The volume deviation is 11.26\u00a0mm³/);
});

test("the coarsest row is over the tolerance; rounding of sums does not count as over", () => {
  expect(rows(compared({ max_error: 0.0650000001 })).map(({ holds }) => holds)).toEqual([true, true, true, false]);
});
