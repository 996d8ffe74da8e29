import { expect, it } from "vitest";
import { HEAT_ROW_FACETS, heatOf, packHeat, type HeatSource } from "./heat.js";

const source: HeatSource = {
  heat: "product",
  weights: Float32Array.of(1, 0.5, 0),
  saliency: Float32Array.of(0.5, 0.5, 1),
  least: 0.3,
};

it("shows the painted weight, the saliency, or their product, never below its least value", () => {
  const of = (change: Partial<HeatSource>): number[] => [0, 1, 2].map((facet) => heatOf({ ...source, ...change }, facet));
  expect(of({ heat: "paint" })).toEqual([1, 0.5, 0]);
  expect(of({ heat: "saliency" })).toEqual([0.5, 0.5, 1]);
  expect(of({})).toEqual([0.5, 0.3, 0.3]);
  expect(of({ saliency: null })).toEqual([1, 0.5, 0.3]);
  expect(of({ weights: null, saliency: null })).toEqual([1, 1, 1]);
});

it("writes only the facets that changed, and returns their rows", () => {
  const into = new Uint8Array(2 * HEAT_ROW_FACETS);
  expect([...packHeat({ ...source, weights: null, saliency: null }, [1, HEAT_ROW_FACETS], into)]).toEqual([0, 1]);
  expect([into[0], into[1], into[HEAT_ROW_FACETS]]).toEqual([0, 255, 255]);
  expect(packHeat(source, [], into).size).toBe(0);
});
