import { expect, test } from "vitest";
import type { Options, Report } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { rows, sentence as sentenceIn, type Compared } from "./comparison.js";
import { report, uniform } from "./report-fixture.js";

const sentence = (compared: Compared): string => sentenceIn(compared, languageOf("en"));

const limits = [0.05, 0.15] as const;

const compared = (patch: Partial<Report>, options: Options = {}): Compared => ({ report: report(patch), limits, options });

test("the gain over the finest uniform plan, in layers or in time", () => {
  expect(sentence(compared({}))).toBe("34% fewer than uniform 0.05\u00a0mm (1,200), same tolerance.");
  expect(sentence(compared({}, { minimize: "time" }))).toBe(
    "32% less time than uniform 0.05\u00a0mm (3\u00a0h\u00a040\u00a0min), same tolerance.",
  );
});

test("a plan that gains nothing says so", () => {
  expect(sentence(compared({ layers: 1200 }))).toMatch(/^As many as uniform 0.05/);
  expect(sentence(compared({ print_time_s: 13_200 }, { minimize: "time" }))).toMatch(/^As slow as uniform 0.05/);
});

test("a plan as short as the coarsest uniform plan, if that keeps the tolerance", () => {
  const both = { finest: uniform(1200, 0.01, 13_200), coarsest: uniform(400, 0.03, 5_538) };
  expect(sentence(compared({ layers: 400, uniform: both }))).toMatch(/^As few as uniform 0.15/);
  expect(sentence(compared({ print_time_s: 5_538, uniform: both }, { minimize: "time" }))).toMatch(/^As quick as uniform 0.15/);
});

test("a plan longer than a coarsest uniform plan that keeps the tolerance too says so", () => {
  const both = { finest: uniform(1200, 0.01, 13_200), coarsest: uniform(792, 0.03, 5_538) };
  expect(sentence(compared({ uniform: both }))).toMatch(/^34% fewer than .*, but uniform 0.15\u00a0mm keeps the tolerance as well\.$/);
});

test("a uniform plan over the tolerance says by how much, in the unit of its metric", () => {
  const over = { planner: "uniform", max_error: 0.1 };
  expect(sentence(compared(over))).toMatch(/^The largest step is 0.1\u00a0mm, more than the 0.065/);
  expect(sentence(compared({ ...over, metric: "area" }))).toBe("The area deviation is 10%, more than the 6.5% allowed.");
  expect(sentence(compared({ ...over, metric: "volume", max_error: 11.26 }))).toMatch(/^The volume deviation is 11.26\u00a0mm³/);
});

test("the coarsest row is over the tolerance; rounding of sums does not count as over", () => {
  expect(rows(compared({ max_error: 0.0650000001 })).map(({ holds }) => holds)).toEqual([true, true, false]);
});
