import { expect, it } from "vitest";
import { ball, box, cone, together } from "../fixtures.js";
import { flatFace } from "./flat.js";
import { topologyOf, type Topology } from "./topology.js";

function finished<Result>(work: Generator<unknown, Result>): Result {
  for (;;) {
    const step = work.next();
    if (step.done === true) return step.value;
  }
}

const topology = (positions: Float32Array): Topology => finished(topologyOf(positions));

it.each([
  ["a box", box([0, 0, 0], [1, 2, 3]), 8],
  ["a cone", cone(5, 9, 12), 14],
  ["a ball", ball(3, 16), 2 + 7 * 16],
])("finds the points of %s and the twin of every half-edge", (_, positions, points) => {
  const { corner, twin, points: found } = topology(positions);
  expect(found).toHaveLength(3 * points);
  for (const [edge, other] of twin.entries()) {
    expect(other).toBeGreaterThanOrEqual(0);
    expect(twin[other]).toBe(edge);
    const next = (at: number): number => (at % 3 === 2 ? at - 2 : at + 1);
    expect(corner[other]).toBe(corner[next(edge)]);
    expect(corner[next(other)]).toBe(corner[edge]);
  }
  for (const [at, point] of corner.entries()) {
    expect([...found.subarray(3 * point, 3 * point + 3)].map((value) => value + 0)).toEqual(
      [...positions.subarray(3 * at, 3 * at + 3)].map((value) => value + 0),
    );
  }
});

it("leaves the edges of a hole without a twin", () => {
  const open = box([0, 0, 0], [1, 1, 1]).slice(18);
  expect([...topology(open).twin].filter((twin) => twin < 0)).toHaveLength(4);
});

it("takes a side of a box as a face, and no facet of another box", () => {
  const positions = together(box([0, 0, 0], [1, 2, 3]), box([5, 0, 0], [6, 2, 3]));
  const face = flatFace(positions, topology(positions), 2);
  expect(face?.facets.toSorted()).toEqual([2, 3]);
  expect(face?.normal).toEqual([0, 0, 1]);
  expect(face?.area_mm2).toBeCloseTo(2, 6);
});

it("takes the whole base of a cone", () => {
  const positions = cone(5, 9, 24);
  const face = flatFace(positions, topology(positions), 1);
  expect(face?.facets).toHaveLength(24);
  expect(face?.normal[2]).toBeCloseTo(-1, 6);
  expect(face?.area_mm2).toBeCloseTo(12 * 25 * Math.sin((2 * Math.PI) / 24), 4);
});

it("reaches over a curved surface as far as the angle allows", () => {
  const positions = ball(10, 120);
  const topologyOfBall = topology(positions);
  const facet = 119 * 60;
  const narrow = flatFace(positions, topologyOfBall, facet, 3)?.facets.length ?? 0;
  const wide = flatFace(positions, topologyOfBall, facet, 6)?.facets.length ?? 0;
  expect(narrow).toBeGreaterThan(1);
  expect(wide).toBeGreaterThan(2 * narrow);
});

it("finds no face at a facet without area", () => {
  expect(flatFace(new Float32Array(9), topology(new Float32Array(9)), 0)).toBeNull();
});
