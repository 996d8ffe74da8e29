import { expect, test } from "vitest";
import { report, uniform, uniforms } from "../state/report-fixture.js";
import { gradesOf, pictureOf } from "./quality.js";

const curve = [0.05, 0.1, 0.2].map((max_error, i) => ({ tolerance: max_error, max_error, layers: 1, print_time_s: 300 - 100 * i }));

test("the picture of the curve: finer to the right, slower at the top, each point above its notch", () => {
  const own = report({ max_error: 0.075, print_time_s: 250, uniform: uniforms({ finest: uniform(9, 0.05, 400), coarsest: uniform(1, 0.3, 90) }) });
  const picture = pictureOf(curve, { report: own });
  const xs = picture.dots.map(({ x }) => x);
  expect(xs).toEqual([...xs].sort((a, b) => a - b));
  expect(picture.own.x).toBeCloseTo(((xs[1] ?? 0) + (xs[2] ?? 0)) / 2);
  expect([picture.finest.x, picture.coarsest.x]).toEqual([xs[2], xs[0]]);
  expect(picture.finest.y).toBeLessThan(picture.own.y);
  expect(picture.coarsest.y).toBeGreaterThan(picture.own.y);
});

test("draft is the loosest point, fine the tightest, and standard the nearest to the usual tolerance, if that is another", () => {
  const named = (usual: number): Record<string, number> => Object.fromEntries(gradesOf(curve, usual).map(({ name, index }) => [name, index]));
  expect(named(0.11)).toEqual({ draft: 2, standard: 1, fine: 0 });
  expect(named(0.01)).toEqual({ draft: 2, fine: 0 });
  expect(named(1)).toEqual({ draft: 2, fine: 0 });
});
