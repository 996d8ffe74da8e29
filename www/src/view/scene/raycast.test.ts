import { Ray, Vector3 } from "three";
import { expect, it } from "vitest";
import { Raycast } from "./raycast.js";
import { ball, box } from "../fixtures.js";
import { distanceToFacet } from "../paint/region.js";

const positions = ball(10, 48);
const raycast = new Raycast(positions);

it("hits the near side of a ball and names the facet", () => {
  for (const [x, z] of [
    [0.3, 0.2],
    [-4, 6],
    [7, -2.5],
  ] as const) {
    const hit = raycast.cast(new Ray(new Vector3(x, -50, z), new Vector3(0, 1, 0)));
    if (hit === null) throw new Error("the ray missed");
    expect(hit.point[1]).toBeLessThan(0);
    expect(Math.hypot(...hit.point)).toBeCloseTo(10, 0);
    expect(distanceToFacet(positions, hit.facet, hit.point)).toBeLessThan(1e-4);
  }
  expect(raycast.cast(new Ray(new Vector3(11, -50, 0), new Vector3(0, 1, 0)))).toBeNull();
});

it("finds the nearest point, and none beyond the distance", () => {
  const cube = new Raycast(box([0, 0, 0], [2, 2, 2]));
  expect(cube.nearest([1, 1, 2.5], 1)?.point).toEqual([1, 1, 2]);
  expect(cube.nearest([1, 1, 4], 1)).toBeNull();
});

it("does not change the positions", () => {
  expect(positions).toEqual(ball(10, 48));
});
