import { describe, expect, it } from "vitest";
import { ball, box, insideOut, together } from "../fixtures.js";
import { finished, solid } from "../steps/steps-fixture.js";
import { packed, placeIn, unpacked } from "./grid.js";
import { wallsOf, type Walls } from "./thickness.js";

type Point = readonly [number, number, number];

const known = new WeakMap<Float32Array, Walls>();

/** Few enough samples for quick tests. */
const MORE = 6000;

/** Measures each model once. */
function measure(positions: Float32Array): Walls {
  const walls = known.get(positions) ?? finished(wallsOf(solid(positions), MORE));
  known.set(positions, walls);
  return walls;
}

/** Thicknesses of the facets selected by `isMeant`, given the normal, and the centre relative to the centre of the bounds. */
function of(positions: Float32Array, isMeant: (normal: Point, middle: Point) => boolean): number[] {
  const { grids, thickness_mm } = measure(positions);
  const { points, topology } = solid(positions);
  const out: number[] = [];
  for (let facet = 0; facet < positions.length / 9; facet++) {
    const corners = [0, 1, 2].map((i) => {
      const at = 3 * (topology.corner[3 * facet + i] ?? 0);
      return [points[at] ?? 0, points[at + 1] ?? 0, points[at + 2] ?? 0] as const;
    });
    const [a, b, c] = corners as unknown as readonly [Point, Point, Point];
    const [u, v] = [[b[0] - a[0], b[1] - a[1], b[2] - a[2]] as const, [c[0] - a[0], c[1] - a[1], c[2] - a[2]] as const];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as const;
    const length = Math.hypot(...n);
    const middle = [0, 1, 2].map((axis) => ((a[axis] ?? 0) + (b[axis] ?? 0) + (c[axis] ?? 0)) / 3) as unknown as Point;
    if (!isMeant([n[0] / length, n[1] / length, n[2] / length], middle)) continue;
    const { columns, rows } = unpacked(grids[2 * facet + 1] ?? 0);
    const first = grids[2 * facet] ?? 0;
    out.push(...thickness_mm.subarray(first, first + columns * rows));
  }
  expect(out.length).toBeGreaterThan(0);
  return out;
}

const least = (values: readonly number[]): number => values.reduce((a, b) => Math.min(a, b), Infinity);
const most = (values: readonly number[]): number => values.reduce((a, b) => Math.max(a, b), -Infinity);

function expectAll(values: readonly number[], wanted_mm: number, tolerance_mm = 1e-5): void {
  expect(least(values)).toBeGreaterThan(wanted_mm - tolerance_mm);
  expect(most(values)).toBeLessThan(wanted_mm + tolerance_mm);
}

/** Upright prism whose flats are `radius` from its axis. */
function cylinder(radius: number, height: number, sides: number): Float32Array {
  const far = radius / Math.cos(Math.PI / sides);
  const rim = (i: number, z: number): Point => [far * Math.cos((2 * Math.PI * i) / sides), far * Math.sin((2 * Math.PI * i) / sides), z];
  const out: Point[] = [];
  for (let i = 0; i < sides; i++) {
    const [a, b, c, d] = [rim(i, 0), rim(i + 1, 0), rim(i + 1, height), rim(i, height)];
    out.push(a, b, c, a, c, d, b, a, [0, 0, 0], d, c, [0, 0, height]);
  }
  return Float32Array.from(out.flat());
}

describe("the thickness of", () => {
  it("a plate is its height from above and below, and its width and depth from the sides", () => {
    const plate = box([0, 0, 0], [40, 30, 0.35]);
    expectAll(of(plate, ([, , z]) => z ** 2 > 0.5), 0.35);
    expectAll(of(plate, ([x]) => x ** 2 > 0.5), 40);
    expectAll(of(plate, ([, y]) => y ** 2 > 0.5), 30);
  });

  it("a hollow box is that of each of its walls, from outside and from inside", () => {
    const hollow = together(box([0, 0, 0], [20, 20, 20]), insideOut(box([1, 2, 3], [16, 15, 14])));
    const inside = ([x, y, z]: Point): boolean => Math.abs(x) < 9.9 && Math.abs(y) < 9.9 && z > 0.1 && z < 19.9;
    const walls = [
      [[-1, 0, 0], 1],
      [[1, 0, 0], 4],
      [[0, -1, 0], 2],
      [[0, 1, 0], 5],
      [[0, 0, -1], 3],
      [[0, 0, 1], 6],
    ] as const;
    for (const [way, wall_mm] of walls) {
      const along = (n: Point): number => n[0] * way[0] + n[1] * way[1] + n[2] * way[2];
      // The cavity's normals point into it.
      expectAll(of(hollow, (normal, middle) => along(normal) < -0.5 && inside(middle)), wall_mm);
      const outer = of(hollow, (normal, middle) => along(normal) > 0.5 && !inside(middle));
      expect(new Set(outer.map((mm) => mm.toFixed(3)))).toEqual(new Set([wall_mm.toFixed(3), "20.000"]));
    }
  });

  it("a ball is nearly its diameter everywhere", () => {
    const around = 96;
    const values = of(ball(5, around), () => true);
    // A ray against the normal of a flat facet passes the centre at no more than half its side.
    const side = (2 * Math.PI * 5) / around;
    expect(least(values)).toBeGreaterThan(2 * Math.sqrt(25 - side ** 2) - 0.05);
    expect(most(values)).toBeLessThanOrEqual(10);
  });

  it("a ball of more facets than one hierarchy holds is no less", () => {
    const of = solid(ball(5, 280));
    expect(of.topology.corner.length / 3).toBeGreaterThan(2 * 32_768);
    const { thickness_mm } = finished(wallsOf(of, 0));
    expect(thickness_mm).toHaveLength(of.topology.corner.length / 3);
    expect(least([...thickness_mm])).toBeGreaterThan(9.97);
    expect(most([...thickness_mm])).toBeLessThanOrEqual(10);
  });

  it("a cylinder is its diameter from the side, and its height from its ends", () => {
    const rod = cylinder(3, 12, 60);
    expectAll(of(rod, ([, , z]) => z ** 2 < 0.5), 6, 1e-4);
    expectAll(of(rod, ([, , z]) => z ** 2 > 0.5), 12);
  });

  it("bodies that overlap or touch is that of all together", () => {
    expectAll(of(together(box([0, 0, 0], [10, 10, 10]), box([6, 0, 0], [16, 10, 10])), ([x], [at]) => x ** 2 > 0.5 && Math.abs(at) > 7.9), 16);
    expectAll(of(together(box([0, 0, 0], [10, 10, 10]), box([10, 0, 0], [16, 10, 10])), ([x], [at]) => x ** 2 > 0.5 && Math.abs(at) > 7.9), 16);
    // One body twice, and one within another.
    expectAll(of(together(box([0, 0, 0], [10, 10, 10]), box([0, 0, 0], [10, 10, 10]), box([3, 3, 3], [5, 5, 5])), ([x], [at]) => x ** 2 > 0.5 && Math.abs(at) > 4.9), 10);
  });

  it("bodies apart is that of each", () => {
    const values = of(together(box([0, 0, 0], [1, 10, 10]), box([3, 0, 0], [9, 10, 10])), ([x]) => x ** 2 > 0.5);
    expect(new Set(values.map((mm) => mm.toFixed(4)))).toEqual(new Set(["1.0000", "6.0000"]));
  });

  it("a body is the same inside out", () => {
    expectAll(of(insideOut(box([0, 0, 0], [4, 4, 4])), () => true), 4);
    expect(least(of(insideOut(ball(5, 24)), () => true))).toBeCloseTo(least(of(ball(5, 24), () => true)), 4);
  });

  it("a large facet changes in the middle of it", () => {
    // A table: its top is two facets, 2 mm thick between the legs and 12 mm above each.
    const table = together(box([0, 0, 10], [30, 30, 12]), box([0, 0, 0], [5, 30, 10]), box([25, 0, 0], [30, 30, 10]));
    const { grids, thickness_mm } = measure(table);
    const { points, topology } = solid(table);
    let samples = 0;
    for (const facet of [2, 3]) {
      const grid = unpacked(grids[2 * facet + 1] ?? 0);
      for (let row = 0; row < grid.rows; row++) {
        for (let column = 0; column < grid.columns; column++) {
          const weights = placeIn(grid, column, row, 0.517, 0.477);
          const x = weights.reduce((sum, weight, i) => sum + weight * (points[3 * (topology.corner[3 * facet + ((grid.apex + i) % 3)] ?? 0)] ?? 0), 0);
          expect(thickness_mm[(grids[2 * facet] ?? 0) + row * grid.columns + column]).toBeCloseTo(Math.abs(x) > 10 ? 12 : 2, 4);
          samples++;
        }
      }
    }
    expect(samples).toBeGreaterThan(500);
  });

  it("what has a hole is unknown where rays go out through it, and no more than that", () => {
    const open = box([0, 0, 0], [10, 10, 10]).subarray(18);
    expect(of(open, ([, , z]) => z > 0.5).every((mm) => mm === Infinity)).toBe(true);
    expectAll(of(open, ([, , z]) => z < 0.5), 10);
    expect([...measure(new Float32Array(9)).thickness_mm]).toEqual([Infinity]);
    expect(measure(new Float32Array(0)).thickness_mm).toHaveLength(0);
  });
});

it("does not depend on how a model is turned, or on the order of its facets", () => {
  const sorted = (positions: Float32Array): Float32Array => measure(positions).thickness_mm.toSorted();
  const hollow = together(box([0, 0, 0], [9, 12, 15]), insideOut(box([1, 2, 3], [5, 8, 11])));
  const turned = hollow.map((_, i) => hollow[i - (i % 3) + ((i + 1) % 3)] ?? 0);
  const [one, other] = [sorted(hollow), sorted(turned)];
  expect(other).toHaveLength(one.length);
  expect(most([...one].map((mm, i) => Math.abs(mm - (other[i] ?? 0))))).toBeLessThan(1e-4);
  const last = hollow.length / 9 - 1;
  const backwards = hollow.map((_, i) => hollow[9 * (last - Math.floor(i / 9)) + (i % 9)] ?? 0);
  expect(most([...sorted(backwards)].map((mm, i) => Math.abs(mm - (one[i] ?? 0))))).toBeLessThan(1e-4);
});

it("is the same each time, and reports its progress", () => {
  const of = solid(ball(5, 64));
  const told = [...wallsOf(of, MORE)];
  expect(told.length).toBeGreaterThan(20);
  expect(told.toSorted((a, b) => a - b)).toEqual(told);
  expect(told.at(-1)).toBeGreaterThan(0.9);
  expect(told.at(-1)).toBeLessThanOrEqual(1);
  expect(finished(wallsOf(of, MORE)).thickness_mm).toEqual(finished(wallsOf(of, MORE)).thickness_mm);
});

it("agrees with steps through boxes, where they are many", () => {
  // Crossed struts of different widths.
  const struts = Array.from({ length: 24 }, (_, i) => {
    const [at, width] = [1.37 * i, 0.3 + 0.05 * i];
    return i % 2 === 0 ? box([at, 0, 0], [at + width, 40, 3]) : box([0, at, 1], [40, at + width, 4]);
  });
  const positions = together(...struts);
  const { grids, thickness_mm } = measure(positions);
  const { points, topology } = solid(positions);
  const whole = points;
  const at = (facet: number, corner: number): Point => {
    const from = 3 * (topology.corner[3 * facet + corner] ?? 0);
    return [whole[from] ?? 0, whole[from + 1] ?? 0, whole[from + 2] ?? 0];
  };
  const boxes = struts.map((_, i) => {
    const corners = Array.from({ length: 36 }, (__, c) => at(12 * i + Math.floor(c / 3), c % 3));
    return [0, 1, 2].map((axis) => [least(corners.map((p) => p[axis] ?? 0)), most(corners.map((p) => p[axis] ?? 0))] as const);
  });
  const isIn = (p: Point): boolean => boxes.some((ranges) => ranges.every(([low, high], axis) => (p[axis] ?? 0) > low && (p[axis] ?? 0) < high));
  let checked = 0;
  for (let facet = 0; facet < topology.corner.length / 3; facet += 5) {
    const grid = unpacked(grids[2 * facet + 1] ?? 0);
    const cell = (grids[2 * facet] ?? 0) + Math.floor(grid.columns / 3);
    const weights = placeIn(grid, Math.floor(grid.columns / 3), 0, 0.517, 0.477);
    const p = [0, 1, 2].map((axis) => weights.reduce((sum, weight, i) => sum + weight * (at(facet, (grid.apex + i) % 3)[axis] ?? 0), 0));
    // Marches along an axis in steps; the boxes are the oracle.
    const n = [0, 1, 2].map((axis) => {
      const flat = [0, 1, 2].every((corner) => at(facet, corner)[axis] === at(facet, 0)[axis]);
      const [low = 0] = boxes[Math.floor(facet / 12)]?.[axis] ?? [];
      return flat ? (at(facet, 0)[axis] === low ? 1 : -1) : 0;
    });
    const along = (mm: number): Point => p.map((value, axis) => value + mm * (n[axis] ?? 0)) as unknown as Point;
    let mm = 0.005;
    while (isIn(along(mm))) mm += 0.01;
    expect(Math.abs((thickness_mm[cell] ?? 0) - mm), `facet ${facet}`).toBeLessThan(0.011);
    checked++;
  }
  expect(checked).toBeGreaterThan(50);
});

it("packs what a grid is, and its places are on the facet", () => {
  for (const grid of [{ columns: 1, rows: 1, apex: 0 }, { columns: 2048, rows: 3, apex: 2 }]) {
    expect(unpacked(packed(grid))).toEqual(grid);
    const weights = placeIn(grid, grid.columns - 1, grid.rows - 1, 0.9, 0.9);
    expect(weights.reduce((a, b) => a + b)).toBeCloseTo(1, 9);
    expect(Math.min(...weights)).toBeGreaterThan(0);
  }
});
