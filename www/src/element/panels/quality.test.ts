import { expect, test } from "vitest";
import type { Report } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { report, uniform } from "../state/report-fixture.js";
import { gainWords, pictureOf } from "./quality.js";

const limits = [0.05, 0.15] as const;

const curve = [0.05, 0.1, 0.2].map((max_error, i) => ({ tolerance: max_error, max_error, layers: 1, print_time_s: 300 - 100 * i }));

test("the gain in words: the same quality in less time, or less time for a larger step", () => {
  const words = (patch: Partial<Report>): string => gainWords({ report: report(patch), limits }, languageOf("en"));
  expect(words({ max_error: 0.05 })).toBe("Same quality as uniform 0.05\u00a0mm, 32% less time.");
  expect(words({})).toBe("32% less time than uniform 0.05\u00a0mm. The largest step is 0.065\u00a0mm instead of 0.05\u00a0mm.");
  expect(words({ metric: "deviation" })).toContain(". The largest deviation is ");
  expect(words({ print_time_s: 13_200 })).toMatch(/^As slow as uniform/);
});

test("the picture of the curve: finer to the right, slower at the top, each point above its notch", () => {
  const own = report({ max_error: 0.075, print_time_s: 250, uniform: { finest: uniform(9, 0.05, 400), coarsest: uniform(1, 0.3, 90) } });
  const picture = pictureOf(curve, { report: own });
  const xs = picture.dots.map(({ x }) => x);
  expect(xs).toEqual([...xs].sort((a, b) => a - b));
  expect(picture.own.x).toBeCloseTo(((xs[1] ?? 0) + (xs[2] ?? 0)) / 2);
  expect([picture.finest.x, picture.coarsest.x]).toEqual([xs[2], xs[0]]);
  expect(picture.finest.y).toBeLessThan(picture.own.y);
  expect(picture.coarsest.y).toBeGreaterThan(picture.own.y);
});
