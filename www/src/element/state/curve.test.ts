import { expect, test } from "vitest";
import { SCHEMA, type Slicer } from "../../api/index.js";
import type { Report, TradeoffPoint } from "../../api/wire.js";
import { planOf } from "./fake-slicer.js";
import { Curve, merged, notchOf, placeAmong } from "./curve.js";
import { pictureOf } from "../panels/quality.js";
import type { Result } from "./result.js";

const point = (tolerance: number, layers: number, max_error: number, print_time_s: number): TradeoffPoint => ({
  ...{ tolerance, layers, max_error, print_time_s },
});

/** Output of `cusp tradeoff --points 5` for an upright prism 20 mm high, by cusp height: only its flats have an error. */
const PRISM = Array.from({ length: 5 }, () => point(0.002, 134, 0.002, 1920));

/** First points for the same prism, by roughness. */
const ROUGH = [
  point(0.052, 385, 0.052, 4200),
  point(0.05219, 385, 0.052, 4200),
  point(0.05274, 385, 0.052, 4200),
  point(0.05367, 385, 0.052, 4200),
  point(0.05496, 371, 0.054, 4080),
  point(0.05663, 358, 0.056, 3960),
];

const uniform = (max_error: number, layers: number, print_time_s: number): Report["uniform"]["finest"] => ({
  ...{ planner: "uniform", layers, max_error, print_time_s },
});

function resultOf(plan: TradeoffPoint): Result {
  const [finest, coarsest] = [uniform(0.05, 400, 4400), uniform(0.15, 134, 1920)];
  const report = { planner: "optimal", ...plan, uniform: { finest, coarsest } };
  return { ...planOf(1), report: report as unknown as Report, options: {}, own: undefined, limits: [0.05, 0.15] };
}

async function curveOf(points: TradeoffPoint[], plan: TradeoffPoint): Promise<Curve> {
  const curve = new Curve();
  const slicer: Pick<Slicer, "tradeoff"> = { tradeoff: async () => ({ schema: SCHEMA, points }) };
  await curve.fetch(slicer, resultOf(plan));
  return curve;
}

test("a prism has one plan and so one notch, whatever its tolerance", async () => {
  const curve = await curveOf(PRISM, point(0.065, 134, 0.002, 1920));
  expect(curve.points).toEqual([PRISM[0]]);
  for (const wanted of [0, 0.5, 1]) {
    curve.wanted = wanted;
    expect(curve.takeWanted()).toBe(0);
  }
  expect(curve.placeOf(point(0.065, 134, 0.002, 1920))).toBe(1);
});

test("tolerances with the same plan share one notch, that of the tightest", () => {
  expect(merged(ROUGH).map(({ tolerance }) => tolerance)).toEqual([0.052, 0.05496, 0.05663]);
  expect(merged([])).toEqual([]);
});

test.each([
  // Its tolerance is nearest to that of the middle point, but its plan is the finest.
  [point(0.05425, 385, 0.052, 4200), 2],
  [point(0.0559, 371, 0.054, 4080), 1],
  [point(9, 358, 0.056, 3960), 0],
  [point(0.0545, 371, 0.0545, 4090), 1],
])("slider and dot are at the same notch, by the plan and not by its tolerance: %j", (plan, notch) => {
  const points = merged(ROUGH);
  expect(notchOf(points, plan)).toBe(notch);
  const { dots, own } = pictureOf(points, resultOf(plan));
  const nearest = dots.map(({ x }) => Math.abs(x - own.x));
  expect(nearest.indexOf(Math.min(...nearest))).toBe(notch);
});

test("plans with the same error and different times have separate notches", () => {
  const points = [point(0.05, 300, 0.05, 3000), point(0.06, 290, 0.05, 2900), point(0.07, 200, 0.07, 2000)];
  expect(merged(points)).toEqual(points);
  expect(points.map((plan) => notchOf(points, plan))).toEqual([2, 1, 0]);
});

test("finer plans are further along; those finer or coarser than all points are at an end", () => {
  const points = [0.0625, 0.125, 0.25].map((error, i) => point(error, 1, error, 300 - 100 * i));
  const at = (max_error: number): number => placeAmong(points, point(max_error, 7, max_error, 1));
  expect([0.01, 0.09375, 0.125, 0.1875, 9].map(at)).toEqual([2, 1.5, 1, 0.5, 0]);
});

test("the curve is there again after a plan of other options, and after an abort", async () => {
  const plan = point(0.065, 134, 0.002, 1920);
  const [adaptive, other] = [resultOf(plan), { ...resultOf(plan), options: { rays: 512 } }];
  const curve = await curveOf(PRISM, plan);
  curve.fit(other);
  expect(curve.points).toBeNull();
  curve.fit(adaptive);
  const aborting: Pick<Slicer, "tradeoff"> = { tradeoff: () => Promise.reject(new DOMException("ended", "AbortError")) };
  await expect(curve.fetch(aborting, adaptive)).rejects.toThrow("ended");
  const slicer: Pick<Slicer, "tradeoff"> = { tradeoff: async () => ({ schema: SCHEMA, points: PRISM }) };
  expect(await curve.fetch(slicer, adaptive)).toBe(true);
  expect(curve.points).toEqual([PRISM[0]]);
});
