import { describe, expect, it } from "vitest";
import { ball, box, cone, together } from "../fixtures.js";
import { spotsOf, type Seen, type Spot } from "./spots.js";
import { finished } from "../steps/steps-fixture.js";
import type { Triple } from "./pose.js";
import { unit } from "./turn.js";

const seen = (towards: Triple): Seen => ({ height: [0, 0, 1, 0], towards: unit(towards) });
const layers = (height: number, thickness: number): number[] =>
  Array.from({ length: Math.round(height / thickness) + 1 }, (_, i) => i * thickness);
const spots = (positions: Float32Array, z_mm: readonly number[], towards: Triple): Spot[] =>
  finished(spotsOf(positions, z_mm, seen(towards)));

/** The facets moved along x. */
const moved = (positions: Float32Array, by_mm: number): Float32Array => positions.map((value, i) => (i % 3 === 0 ? value + by_mm : value));

describe("the places with the largest steps", () => {
  it("are on the side that faces the viewer", () => {
    const z_mm = layers(10, 0.1);
    for (const towards of [[0, -1, 0.4], [1, 0, 0.4], [-1, 1, 0.4]] as const) {
      const found = spots(cone(10, 10, 64), z_mm, towards);
      expect(found.length).toBeGreaterThan(0);
      for (const { point } of found) expect(point[0] * towards[0] + point[1] * towards[1]).toBeGreaterThan(0);
    }
  });

  it("are where a slope is shallow rather than where it is steep", () => {
    const both = together(cone(10, 10, 64), moved(cone(10, 40, 64), 30));
    const [first] = spots(both, layers(40, 0.1), [0, -1, 0.4]);
    expect(first?.point[0]).toBeLessThan(15);
  });

  it("are where layers are thick", () => {
    const z_mm = [...layers(5, 0.05), ...layers(5, 0.2).slice(1).map((z) => z + 5)];
    const [first] = spots(ball(5, 64).map((value, i) => (i % 3 === 2 ? value + 5 : value)), z_mm, [0, -1, 0.4]);
    expect(first?.point[2]).toBeGreaterThan(5);
    expect(first?.thickness_mm).toBeCloseTo(0.2, 9);
  });

  it("are none on a box, which has walls and level tops only", () => {
    expect(spots(box([0, 0, 0], [10, 10, 10]), layers(10, 0.1), [0.5, -1, 0.4])).toEqual([]);
  });

  it("do not depend on the order of the facets", () => {
    const positions = cone(10, 10, 16);
    const reversed = Float32Array.from({ length: positions.length }, (_, i) => {
      const facet = positions.length / 9 - 1 - Math.floor(i / 9);
      return positions[9 * facet + (i % 9)] ?? 0;
    });
    const at = (found: Spot[]): Triple | undefined => found[0]?.point;
    expect(at(spots(reversed, layers(10, 0.1), [0.3, -1, 0.4]))).toEqual(at(spots(positions, layers(10, 0.1), [0.3, -1, 0.4])));
  });
});
