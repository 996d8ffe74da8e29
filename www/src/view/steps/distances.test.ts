import { describe, expect, it } from "vitest";
import type { Solid } from "./contours.js";
import { measured, type MeasuredSteps } from "./distances.js";
import { ball, box, cone, together } from "../fixtures.js";
import { turned, UPRIGHT } from "../scene/pose.js";
import { finished, layers, solid } from "./steps-fixture.js";
import { stairSteps } from "./steps.js";

type Point = readonly [number, number, number];

const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const lengthOf = (a: Point): number => Math.sqrt(dot(a, a));

function toSegment(p: Point, a: Point, b: Point): number {
  const along = minus(b, a);
  const part = Math.min(1, Math.max(0, dot(minus(p, a), along) / dot(along, along)));
  return lengthOf(minus(minus(p, a), [part * along[0], part * along[1], part * along[2]]));
}

/** Distance to the plane if the point is above or below the facet, otherwise to the nearest edge. */
function toFacet(p: Point, [a, b, c]: readonly [Point, Point, Point]): number {
  const normal = cross(minus(b, a), minus(c, a));
  const isInside = (from: Point, to: Point): boolean => dot(cross(minus(to, from), minus(p, from)), normal) >= 0;
  if (isInside(a, b) && isInside(b, c) && isInside(c, a)) return Math.abs(dot(minus(p, a), normal)) / lengthOf(normal);
  return Math.min(toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a));
}

/** Distance to the nearest of all facets. */
function naive({ points, topology }: Solid, p: Point): number {
  const at = (corner: number): Point => {
    const first = 3 * (topology.corner[corner] ?? 0);
    return [points[first] ?? 0, points[first + 1] ?? 0, points[first + 2] ?? 0];
  };
  let least = Infinity;
  for (let corner = 0; corner < topology.corner.length; corner += 3) {
    least = Math.min(least, toFacet(p, [at(corner), at(corner + 1), at(corner + 2)]));
  }
  return least;
}

const measure = (of: Solid, z_mm: readonly number[]): MeasuredSteps => finished(measured(of, finished(stairSteps(of, z_mm))));

/** All corners of the steps with their distances. */
const corners = ({ parts }: MeasuredSteps): [Point, number][] =>
  parts.flatMap(({ positions, away_mm }) =>
    Array.from(away_mm, (away, i): [Point, number] => [[...positions.subarray(3 * i, 3 * i + 3)] as unknown as Point, away]),
  );

/** Ramp that rises from `length` to 0 along x, with a vertical back at x = 0. */
function ramp(length: number, height: number, width: number): Float32Array {
  const [a, b, c]: readonly Point[] = [[0, 0, 0], [length, 0, 0], [0, 0, height]] as const;
  const [d, e, f]: readonly Point[] = [[0, width, 0], [length, width, 0], [0, width, height]] as const;
  return Float32Array.from([a, b, c, d, f, e, a, d, e, a, e, b, b, e, f, b, f, c, a, c, f, a, f, d].flatMap((point) => [...(point ?? [])]));
}

/** Lower half of a cone of height 2 · `height`. */
function frustum(radius: number, height: number, around: number): Float32Array {
  const at = (turn: number, out: number, z: number): Point => {
    const angle = (2 * Math.PI * (turn % around)) / around;
    return [out * Math.cos(angle), out * Math.sin(angle), z];
  };
  const points: Point[] = [];
  for (let turn = 0; turn < around; turn++) {
    const [a, b] = [at(turn, radius, 0), at(turn + 1, radius, 0)];
    const [c, d] = [at(turn, radius / 2, height), at(turn + 1, radius / 2, height)];
    points.push(a, b, d, a, d, c, b, a, [0, 0, 0], c, d, [0, 0, height]);
  }
  return Float32Array.from(points.flat());
}

/** Distance shown at a place on a horizontal triangle, interpolated between its corners. */
function shown({ parts }: MeasuredSteps, [x, y, z]: Point): number {
  for (const { positions, index, away_mm } of parts) {
    for (let i = 0; i < index.length; i += 3) {
      const [a = 0, b = 0, c = 0] = index.subarray(i, i + 3);
      const at = (corner: number): Point => [positions[3 * corner] ?? 0, positions[3 * corner + 1] ?? 0, 0];
      if ([a, b, c].some((corner) => Math.abs((positions[3 * corner + 2] ?? 0) - z) > 1e-4)) continue;
      const area = (p: Point, q: Point, r: Point): number => cross(minus(q, p), minus(r, p))[2];
      const [u, v, w] = [area([x, y, 0], at(b), at(c)), area([x, y, 0], at(c), at(a)), area([x, y, 0], at(a), at(b))];
      if (Math.min(u, v, w) < 0) continue;
      return (u * (away_mm[a] ?? 0) + v * (away_mm[b] ?? 0) + w * (away_mm[c] ?? 0)) / (u + v + w);
    }
  }
  throw new Error("there is no tread");
}

describe("distances of the stair steps", () => {
  it("are zero where the layers fit", () => {
    const { greatest_mm, parts } = measure(solid(box([0, 0, 0], [20, 30, 10])), layers(10, 0.5));
    expect(greatest_mm).toBe(0);
    expect(parts.flatMap(({ away_mm }) => [...away_mm])).toHaveLength(20 * 8);
  });

  it.each([5, 30, 45, 80])("on a ramp of %d° are half a layer's thickness times |n_z| at every edge", (degrees) => {
    const [height, layer] = [10, 0.25];
    const slope = (degrees * Math.PI) / 180;
    const of = solid(ramp(height / Math.tan(slope), height, 7));
    const wanted = (layer / 2) * Math.cos(slope);
    const z_mm = layers(height, layer);
    const steps = measure(of, z_mm);
    expect(steps.greatest_mm).toBeCloseTo(wanted, 5);
    // Corners beyond the ramp; the others lie on its sides.
    const [first] = finished(stairSteps(of, z_mm)).parts;
    const all = corners(steps).slice(0, (first?.positions.length ?? 0) / 3);
    const tops = all.filter(([[x, , z]]) => (x + height / Math.tan(slope) / 2) * Math.tan(slope) > height - z + 1e-3);
    expect(tops).toHaveLength(2 * (height / layer));
    for (const [, away] of all.filter((it) => !tops.includes(it))) expect(away).toBe(0);
    for (const [, away] of tops) expect(away).toBeCloseTo(wanted, 5);
  });

  it.each([
    ["a ball", ball(5, 24), UPRIGHT],
    ["a cone that lies", cone(6, 9, 48), turned(UPRIGHT, "x", 77)],
    ["a ball through a box", together(ball(4, 32), box([-5, -2, -1], [5, 2, 2])), turned(UPRIGHT, "y", 20)],
    ["a ball of many facets", ball(5, 64), turned(UPRIGHT, "y", 31)],
  ])("of %s are those to the nearest of all facets", (_, positions, rotation) => {
    const of = solid(positions, rotation);
    const steps = measure(of, layers(9, 0.37));
    // Corners farther away are hidden under the next layer.
    const reach = 0.37 / 2 + steps.tolerance_mm;
    const isSeen = (away: number): boolean => away < reach - 1e-3;
    const all = corners(steps);
    expect(steps.greatest_mm).toBeGreaterThan(0.15);
    expect(steps.greatest_mm).toBeLessThanOrEqual(0.37 / 2);
    expect(all.map(([, away]) => away)).toContain(steps.greatest_mm);
    const every = Math.ceil((all.length * of.topology.corner.length) / 300_000);
    for (let i = 0; i < all.length; i += every) {
      const [point, away] = all[i] ?? [[0, 0, 0], 0];
      const wanted = naive(of, point);
      if (isSeen(wanted)) expect(Math.abs(away - Math.min(wanted, steps.greatest_mm)), String(point)).toBeLessThan(2e-5);
      else expect(away, String(point)).toBeLessThanOrEqual(reach);
    }
  }, 20_000);

  it("are found between corners that are on other facets", () => {
    // The ramp is between two walls, which contain the corners at both ends of each edge.
    const slope = Math.PI / 4;
    const [left, right] = [box([-1, -2, 0], [11, 0, 12]), box([-1, 7, 0], [11, 9, 12])];
    const { greatest_mm } = measure(solid(together(left, ramp(10, 10, 7), right)), layers(12, 0.25));
    expect(greatest_mm).toBeCloseTo(0.125 * Math.cos(slope), 5);
  });

  it("are zero on a flat within sloping sides", () => {
    // A truncated cone: the rim of its flat deviates, everything inside is on the model.
    const [radius, height] = [10, 8];
    const of = solid(frustum(radius, height, 64));
    const steps = measure(of, layers(height, 0.5));
    const wanted = 0.25 * Math.cos(Math.atan(2 * height / (radius * Math.cos(Math.PI / 64))));
    expect(steps.greatest_mm).toBeGreaterThan(wanted - 1e-4);
    expect(shown(steps, [0.3, 0.2, height])).toBeLessThan(1e-4);
    expect(shown(steps, [3.9, 1.2, height])).toBeLessThan(0.02);
  });

  it("count the facet of the own body where bodies overlap", () => {
    const { greatest_mm } = measure(solid(together(box([0, 0, 0], [10, 10, 10]), box([5, 5, 0], [15, 15, 10]))), layers(10, 1));
    expect(greatest_mm).toBe(0);
  });

  it("report their progress", () => {
    const of = solid(ball(5, 64));
    const told = [...measured(of, finished(stairSteps(of, layers(10, 0.25))))];
    expect(told.length).toBeGreaterThan(20);
    expect(told.toSorted((a, b) => a - b)).toEqual(told);
    expect(told.at(-1)).toBeGreaterThan(0.9);
    expect(told.at(-1)).toBeLessThanOrEqual(1);
  });
});
