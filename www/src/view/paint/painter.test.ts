import { describe, expect, it } from "vitest";
import { BRUSH, falloff, rebased, type Brush } from "./brush.js";
import { ball, box, together } from "../fixtures.js";
import { mirrored, Painter, type Dab } from "./painter.js";
import type { Triple } from "../scene/pose.js";
import { brushRegion, distanceToFacet, normalsOf, smoothRegion, type Surface } from "./region.js";
import { topologyOf } from "../scene/topology.js";

function surfaceOf(positions: Float32Array): Surface {
  const work = topologyOf(positions);
  let step = work.next();
  while (step.done !== true) step = work.next();
  return { positions, topology: step.value, normals: normalsOf(positions) };
}

const RADIUS = 10;
const globe = surfaceOf(ball(RADIUS, 64));
const brush = (change: Partial<Brush>): Brush => ({ ...BRUSH, size_mm: 6, ...change });

function centroid({ positions }: Surface, facet: number): Triple {
  const of = (axis: number): number =>
    ((positions[9 * facet + axis] ?? 0) + (positions[9 * facet + 3 + axis] ?? 0) + (positions[9 * facet + 6 + axis] ?? 0)) / 3;
  return [of(0), of(1), of(2)];
}

/** A dab at the centre of a facet. */
const on = (surface: Surface, facet: number, from: Triple | null = null): Dab => ({
  facet,
  point: centroid(surface, facet),
  from,
});

const facetsOf = ({ positions }: Surface): number[] => [...Array(positions.length / 9).keys()];

/** Minimum distance to points sampled from a facet, which the closed form must not exceed. */
function strewn(positions: Float32Array, facet: number, [x, y, z]: Triple, steps: number): number {
  const at = (corner: number, axis: number): number => positions[9 * facet + 3 * corner + axis] ?? 0;
  let least = Infinity;
  for (let i = 0; i <= steps; i++) {
    for (let j = 0; i + j <= steps; j++) {
      const [v, w] = [i / steps, j / steps];
      const on = (axis: number): number => (1 - v - w) * at(0, axis) + v * at(1, axis) + w * at(2, axis);
      least = Math.min(least, Math.hypot(x - on(0), y - on(1), z - on(2)));
    }
  }
  return least;
}

describe("regions", () => {
  it("measures the distance from a facet as points sampled from it do", () => {
    const positions = Float32Array.of(0, 0, 0, 3, 1, 0, 1, 2, 1);
    const steps = 60;
    let seed = 7;
    const random = (): number => (seed = (seed * 16807) % 2147483647) / 2147483647;
    for (let i = 0; i < 300; i++) {
      const point: Triple = [6 * random() - 2, 6 * random() - 2, 6 * random() - 2];
      const [exact, near] = [distanceToFacet(positions, 0, point), strewn(positions, 0, point, steps)];
      expect(exact).toBeLessThanOrEqual(near + 1e-9);
      // Samples are at most the longest side divided by `steps` apart.
      expect(near - exact).toBeLessThan(Math.sqrt(10) / steps);
    }
  });

  it("takes the facets of a ball within the sphere, and no others", () => {
    const seed = 1000;
    const point = centroid(globe, seed);
    const { facets, distances_mm } = brushRegion(globe, seed, [point], 3);
    const within = facetsOf(globe).filter((facet) => distanceToFacet(globe.positions, facet, point) <= 3);
    expect([...facets].sort((a, b) => a - b)).toEqual(within);
    expect(Math.max(...distances_mm)).toBeLessThanOrEqual(3);
    expect(within.length).toBeLessThan(globe.positions.length / 9 / 4);
  });

  it("reaches neither through a thin wall nor to another body", () => {
    const wall = surfaceOf(box([0, 0, 0], [10, 0.5, 10]));
    const front = facetsOf(wall).find((facet) => (wall.normals[3 * facet + 1] ?? 0) < -0.5) ?? 0;
    const { facets } = brushRegion(wall, front, [centroid(wall, front)], 100);
    for (const facet of facets) expect(wall.normals[3 * facet + 1]).toBeLessThan(-0.5);
    expect(facets).toHaveLength(2);

    const two = surfaceOf(together(box([0, 0, 0], [1, 1, 1]), box([1.1, 0, 0], [2, 1, 1])));
    expect(Math.max(...brushRegion(two, 0, [centroid(two, 0)], 100).facets)).toBeLessThan(12);
  });

  it("fills a side of a box, a whole ball, and a box if every edge is smooth enough", () => {
    const cube = surfaceOf(box([0, 0, 0], [1, 2, 3]));
    for (const seed of facetsOf(cube)) {
      expect(smoothRegion(cube, seed, 30)).toHaveLength(2);
      expect(smoothRegion(cube, seed, 90)).toHaveLength(12);
    }
    expect(smoothRegion(globe, 5, 30)).toHaveLength(globe.positions.length / 9);
  });

  it("takes the same facets however they are numbered", () => {
    const count = globe.positions.length / 9;
    const turn = (facet: number): number => (facet * 17 + 5) % count;
    const positions = new Float32Array(globe.positions.length);
    for (let facet = 0; facet < count; facet++) {
      positions.set(globe.positions.subarray(9 * facet, 9 * facet + 9), 9 * turn(facet));
    }
    const dab = centroid(globe, 700);
    const expected = brushRegion(globe, 700, [dab], 3).facets.map(turn);
    const found = brushRegion(surfaceOf(positions), turn(700), [dab], 3).facets;
    expect(new Set(found)).toEqual(new Set(expected));
  });
});

describe("the brush", () => {
  it("fades from the middle to the rim", () => {
    expect([0, 1, 2, 3, 9].map((mm) => falloff(mm, 2))).toEqual([1, 1, 0, 0, 0]);
    const way = Array.from({ length: 21 }, (_, i) => falloff(i / 10, 2));
    expect(way).toEqual([...way].sort((a, b) => b - a));
  });

  it("paints a facet once per stroke, however often it passes", () => {
    const painter = new Painter(globe, null, 1);
    const half = brush({ strength: 0.5 });
    expect(painter.dab(on(globe, 1000), half, 1).length).toBeGreaterThan(10);
    expect(painter.weights[1000]).toBe(0.5);
    expect(painter.dab(on(globe, 1000), half, 1)).toEqual([]);
    expect(painter.end()).toBe(true);
    painter.dab(on(globe, 1000), half, 1);
    expect(painter.weights[1000]).toBe(0.25);
  });

  it("returns the facets that it changed, and changes no others", () => {
    const painter = new Painter(globe, null, 1);
    const changed = painter.dab(on(globe, 1000), brush({}), 1);
    expect(facetsOf(globe).filter((facet) => painter.weights[facet] !== 1)).toEqual([...changed].sort((a, b) => a - b));
  });

  it("keeps its size on a scaled model", () => {
    const plain = new Painter(globe, null, 1).dab(on(globe, 1000), brush({ size_mm: 6 }), 1);
    const scaled = new Painter(globe, null, 1).dab(on(globe, 1000), brush({ size_mm: 12 }), 2);
    expect(scaled).toEqual(plain);
  });

  it("leaves no gaps between two moves of the pointer", () => {
    const painter = new Painter(globe, null, 1);
    const thin = brush({ size_mm: 2 });
    // A path of a few radii along the equator.
    const [from, to] = [at(0), at(0.6)];
    painter.dab({ ...near(from), from: null }, thin, 1);
    painter.dab({ ...near(to), from }, thin, 1);
    for (let angle = 0; angle < 0.6; angle += 0.05) expect(painter.weights[near(at(angle)).facet]).toBeLessThan(1);
  });

  it("erases to the base, which unpainted facets follow", () => {
    const painter = new Painter(globe, null, 0.5);
    painter.dab(on(globe, 1000), brush({ mode: "more" }), 1);
    painter.end();
    expect(painter.weights[1000]).toBe(1);
    const other = rebased(painter.weights, 0.5, 0.75);
    expect([other[1000], other[0]]).toEqual([1, 0.75]);
    painter.dab(on(globe, 1000), brush({ mode: "erase", base: 0.5 }), 1);
    expect(painter.weights[1000]).toBe(0.5);
  });

  it("softens an edge between weights, and keeps equal weights", () => {
    const painter = new Painter(globe, globe.positions.slice(0, globe.positions.length / 9).fill(0.5), 1);
    const soft = brush({ mode: "soften" });
    expect(painter.dab(on(globe, 1000), soft, 1)).toEqual([]);
    painter.end();
    painter.weights[1000] = 1;
    painter.dab(on(globe, 1000), soft, 1);
    expect(painter.weights[1000]).toBe(0.5);
    // Softening spreads the weight over the adjacent facets.
    expect(Math.max(...painter.weights)).toBeGreaterThan(0.5);
  });

  it("undoes and redoes whole strokes, to the bit", () => {
    const painter = new Painter(globe, null, 1);
    const states = [painter.weights.slice()];
    for (const facet of [200, 1000, 1010]) {
      painter.dab(on(globe, facet), brush({ strength: 0.7 }), 1);
      painter.end();
      states.push(painter.weights.slice());
    }
    const clear = new Float32Array(painter.weights.length).fill(1);
    expect(painter.replace(clear)).toBe(true);
    expect(painter.replace(clear)).toBe(false);
    for (const state of [...states].reverse()) {
      painter.strokes.undo(painter.weights);
      expect(painter.weights).toEqual(state);
      if (state === states[0]) break;
    }
    expect(painter.strokes.canUndo).toBe(false);
    painter.strokes.redo(painter.weights);
    expect(painter.weights).toEqual(states[1]);
    painter.dab(on(globe, 5), brush({}), 1);
    painter.end();
    expect(painter.strokes.canRedo).toBe(false);
  });

  it("mirrors at the middle", () => {
    expect(mirrored([3, 4, 5], 1)).toEqual([-1, 4, 5]);
    expect(mirrored(mirrored([3, 4, 5], 1), 1)).toEqual([3, 4, 5]);
  });
});

/** A point near the ball's equator. */
const at = (angle: number): Triple => [RADIUS * Math.cos(angle), RADIUS * Math.sin(angle), 0.3];

/** The facet nearest to a point, by brute force. */
function near(point: Triple): { facet: number; point: Triple } {
  const distance = (facet: number): number => distanceToFacet(globe.positions, facet, point);
  return { facet: facetsOf(globe).reduce((best, facet) => (distance(facet) < distance(best) ? facet : best)), point };
}
