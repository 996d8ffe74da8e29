import { describe, expect, it } from "vitest";
import { cutsOf, signedArea, simplified, tracer, type Contour, type Solid } from "./contours.js";
import { ball, box, cone, insideOut, together } from "../fixtures.js";
import { turned, UPRIGHT } from "../scene/pose.js";
import { finished, layers, solid } from "./steps-fixture.js";
import { middles, polygons, stairSteps, type Steps, type StepsPart } from "./steps.js";

function sections(of: Solid, planes: readonly number[], tolerance = 0): Contour[][] {
  const cuts = finished(cutsOf(of, planes));
  const trace = tracer(of, tolerance);
  return planes.map((z, i) => trace(z, cuts.facets.subarray(cuts.start[i], cuts.start[i + 1])));
}

const area = (contours: readonly Contour[]): number => contours.reduce((sum, contour) => sum + signedArea(contour), 0);

function perimeter(contour: Contour): number {
  let sum = 0;
  for (let i = 0; i < contour.length; i += 2) {
    const next = (i + 2) % contour.length;
    sum += Math.hypot((contour[next] ?? 0) - (contour[i] ?? 0), (contour[next + 1] ?? 0) - (contour[i + 1] ?? 0));
  }
  return sum;
}

/** Signed volume of triangles, mm³. */
function volume({ parts }: Steps): number {
  return parts.reduce((sum, part) => sum + partVolume(part), 0);
}

function partVolume({ positions, index }: StepsPart): number {
  let six = 0;
  for (let i = 0; i < index.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => positions.subarray(3 * (index[i + k] ?? 0))) as [Float32Array, Float32Array, Float32Array];
    const [ax = 0, ay = 0, az = 0] = a;
    const [bx = 0, by = 0, bz = 0] = b;
    const [cx = 0, cy = 0, cz = 0] = c;
    six += ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx);
  }
  return six / 6;
}

describe("sections", () => {
  it("of a box are its rectangle", () => {
    for (const contours of sections(solid(box([0, 0, 0], [2, 3, 4])), [0.5, 1, 3.9], 1e-6)) {
      expect(contours).toHaveLength(1);
      expect(contours[0]).toHaveLength(8);
      expect(area(contours)).toBeCloseTo(6, 6);
      expect(perimeter(contours[0] ?? [])).toBeCloseTo(10, 6);
    }
  });

  it("of a cube on its corner have the known area", () => {
    // Perpendicular to a diagonal, the section at the middle of a unit cube is a regular hexagon of area 3√3/4.
    const corner = turned(turned(UPRIGHT, "z", 45), "x", (180 / Math.PI) * Math.atan(Math.SQRT2));
    const of = solid(box([0, 0, 0], [1, 1, 1]), corner);
    const [contours = []] = sections(of, [Math.sqrt(3) / 2]);
    expect(area(contours)).toBeCloseTo((3 * Math.sqrt(3)) / 4, 5);
  });

  it("of a ball are the circles of the closed form", () => {
    const [radius, around] = [10, 256];
    const planes = [1, 4, 10, 15, 19.5];
    for (const [i, contours] of sections(solid(ball(radius, around)), planes).entries()) {
      const wanted = Math.sqrt(radius ** 2 - ((planes[i] ?? 0) - radius) ** 2);
      expect(contours).toHaveLength(1);
      expect(area(contours) / (Math.PI * wanted ** 2)).toBeCloseTo(1, 2);
      expect(perimeter(contours[0] ?? []) / (2 * Math.PI * wanted)).toBeCloseTo(1, 2);
    }
  });

  it("run the other way round a hole", () => {
    const tube = together(box([-5, -5, 0], [5, 5, 4]), insideOut(box([-2, -1, 1], [2, 1, 3])));
    const [contours = []] = sections(solid(tube), [2]);
    expect(contours.map(signedArea).map(Math.round).toSorted((a, b) => a - b)).toEqual([-8, 100]);
  });

  it("are whole at the heights of the mesh's points", () => {
    const of = solid(ball(8, 32));
    const heights = [...new Set(Array.from({ length: of.points.length / 3 }, (_, i) => of.points[3 * i + 2] ?? 0))];
    const inner = heights.toSorted((a, b) => a - b).slice(1, -1);
    for (const contours of sections(of, inner)) {
      expect(contours).toHaveLength(1);
      expect(area(contours)).toBeGreaterThan(0);
    }
  });

  it("are closed by a straight line where the mesh is open", () => {
    // One side lacks its two facets, yet the contour closes.
    const open = box([0, 0, 0], [2, 3, 4]).slice(0, -18);
    for (const contours of sections(solid(open), [1, 2, 3])) expect(area(contours)).toBeCloseTo(6, 6);
  });

  it("do not exist above and below", () => {
    expect(sections(solid(box([0, 0, 0], [1, 1, 1])), [-1, 2])).toEqual([[], []]);
  });
});

it("leaves out points on a straight line but no corner", () => {
  const square = [0, 0, 2, 0, 2, 2, 0, 2];
  expect(simplified([0, 0, 1, 0, 2, 0, 2, 2, 0, 2, 0, 1], 1e-9)).toEqual(square);
  expect(simplified([1, 0, 2, 0, 2, 2, 0, 2, 0, 1, 0, 0], 1e-9)).toEqual(square);
  const circle = Array.from({ length: 720 }, (_, i) => [Math.cos((i * Math.PI) / 360), Math.sin((i * Math.PI) / 360)]).flat();
  const coarse = simplified(circle, 0.001);
  expect(coarse.length).toBeLessThan(circle.length / 2);
  // Every chord is within the tolerance of its arc, so the areas differ by no more than tolerance times perimeter.
  expect(signedArea(circle) - signedArea(coarse)).toBeLessThan(0.001 * 2 * Math.PI);
});

it("gives an island in a hole its own polygon", () => {
  const square = (half: number): number[] => [-half, -half, half, -half, half, half, -half, half];
  const hole = (half: number): number[] => [-half, -half, -half, half, half, half, half, -half];
  const found = polygons([square(10), hole(8), square(5), hole(2)]);
  expect(found.map(({ area: size, holes }) => [size, holes.map(signedArea)])).toEqual([
    [100, [-16]],
    [400, [-256]],
  ]);
});

describe("stair steps", () => {
  const tube = together(box([-5, -5, 0], [5, 5, 4]), insideOut(box([-2, -1, 1], [2, 1, 3])));

  it.each([
    ["a box", box([0, 0, 0], [2, 3, 4]), UPRIGHT],
    ["a cone", cone(6, 9, 48), UPRIGHT],
    ["a lying cone", cone(6, 9, 48), turned(UPRIGHT, "x", 77)],
    ["a ball", ball(5, 64), UPRIGHT],
    ["a hollow box", tube, UPRIGHT],
    ["a tilted hollow box", tube, turned(turned(UPRIGHT, "x", 30), "y", 20)],
  ])("of %s have the volume of all sections times their thickness", (_, positions, rotation) => {
    const of = solid(positions, rotation);
    const height = of.points.reduce((most, value, i) => (i % 3 === 2 ? Math.max(most, value) : most), 0);
    const z_mm = layers(height, 0.37);
    const wanted = sections(of, middles(z_mm)).reduce(
      (sum, contours, layer) => sum + area(contours) * ((z_mm[layer + 1] ?? 0) - (z_mm[layer] ?? 0)),
      0,
    );
    const steps = finished(stairSteps(of, z_mm));
    expect(wanted).toBeGreaterThan(1);
    expect(volume(steps) / wanted).toBeCloseTo(1, 3);
    for (const { positions: corners, index } of steps.parts) {
      for (const corner of index) expect(corner).toBeLessThan(corners.length / 3);
    }
  });

  it("of a cone in two layers are two prisms", () => {
    const of = solid(cone(6, 8, 48));
    const steps = finished(stairSteps(of, [0, 4, 8]));
    const base = 24 * 36 * Math.sin((2 * Math.PI) / 48);
    expect(volume(steps)).toBeCloseTo(4 * base * (0.75 ** 2 + 0.25 ** 2), 2);
  });

  it("face outwards even from a mesh that is inside out", () => {
    const z_mm = layers(4, 0.5);
    const [right, wrong] = [box([0, 0, 0], [2, 3, 4]), insideOut(box([0, 0, 0], [2, 3, 4]))].map((positions) =>
      volume(finished(stairSteps(solid(positions), z_mm))),
    );
    expect(right).toBeCloseTo(24, 5);
    expect(wrong).toBeCloseTo(24, 5);
  });

  it("come in parts of whole layers if there are many points", () => {
    const of = solid(ball(5, 256));
    const z_mm = layers(10, 0.01);
    const { parts } = finished(stairSteps(of, z_mm));
    expect(parts.length).toBeGreaterThan(1);
    const tops = parts.map(({ positions: corners }) => corners.reduce((most, z, i) => (i % 3 === 2 ? Math.max(most, z) : most), 0));
    for (const top of tops) expect(z_mm.map(Math.fround)).toContain(top);
    expect(tops.toSorted((a, b) => a - b)).toEqual(tops);
  });

  it("report progress layer by layer", () => {
    const told = [...stairSteps(solid(box([0, 0, 0], [2, 3, 4])), layers(4, 1))];
    expect(told.at(-1)).toBe(1);
    expect(told.toSorted((a, b) => a - b)).toEqual(told);
    expect(told.length).toBeGreaterThanOrEqual(4);
  });
});
