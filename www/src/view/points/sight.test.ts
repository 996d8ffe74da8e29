import { Vector3 } from "three";
import { expect, test } from "vitest";
import type { Viewpoint } from "../scene/viewpoint.js";
import { sighted } from "./sight.js";

const FRONT: Viewpoint = { position: [0, -100, 0], target: [0, 0, 0] };

/** Returns true if a ball at the origin does not hide a point on it from a viewpoint, which must lie beyond the tangent plane. */
const beyond = (point: Vector3) => ({ position }: Viewpoint): boolean => new Vector3(...position).dot(point) > point.lengthSq();

const turned_deg = ({ position: [x, y, z] }: Viewpoint): number => (180 / Math.PI) * Math.acos(-y / Math.hypot(x, y, z));

test("a point that is seen leaves the camera where it is", () => {
  const point = new Vector3(0, -10, 0);
  expect(sighted(FRONT, point, point.clone().normalize(), beyond(point))).toBeNull();
});

test("the camera turns about what it looks at, no farther than it has to, and not to a flat look", () => {
  // From behind the limb the turn is about 90°, plus 15° for a look that is not flat and 15° for the spacing of directions.
  for (const point of [new Vector3(0, 10, 0), new Vector3(7, 7, 0), new Vector3(0, 7, -7)]) {
    const outward = point.clone().normalize();
    const to = sighted(FRONT, point, outward, beyond(point));
    if (to === null) throw new Error("the point is hidden");
    expect(to.target).toEqual(FRONT.target);
    expect(Math.hypot(...to.position)).toBeCloseTo(100);
    expect(beyond(point)(to)).toBe(true);
    const behind = (180 / Math.PI) * Math.acos(-outward.y);
    expect(turned_deg(to)).toBeLessThan(behind - 90 + 45);
    expect(turned_deg(to)).toBeGreaterThan(behind - 90);
  }
});

test("where the view does not have it, the camera turns about the point; where it is hidden from everywhere, it is in front", () => {
  const point = new Vector3(0, 10, 0);
  const outward = new Vector3(0, 1, 0);
  const near = (from: Viewpoint): boolean => beyond(point)(from) && from.target[1] === 10;
  expect(sighted(FRONT, point, outward, near)?.target).toEqual([0, 10, 0]);
  const front = sighted(FRONT, point, outward, () => false);
  expect(front?.target).toEqual([0, 10, 0]);
  expect(front?.position[1]).toBeGreaterThan(100);
});
