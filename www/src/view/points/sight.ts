/** Finds viewpoints from which a point of the model is visible. */
import { Vector3 } from "three";
import type { Viewpoint } from "../scene/viewpoint.js";

/** Angle between candidate directions, radians. */
const STEP = Math.PI / 12;

/** Cosine of the flattest view of the surface; at a lower angle, a marker is hardly visible. */
const LEAST_COSINE = 0.25;

/** Candidate directions, all around but at most 60° steep: beyond that, users lose track of the front. */
const DIRECTIONS: readonly Vector3[] = Array.from({ length: 9 }, (_, row) => (row - 4) * STEP).flatMap((up) =>
  Array.from({ length: 24 }, (_, column) => new Vector3(Math.cos(column * STEP), Math.sin(column * STEP), 0).multiplyScalar(Math.cos(up)).setZ(Math.sin(up))),
);

/** Candidate directions sorted by closeness to `to`. */
const nearest = (to: Vector3): Vector3[] => [...DIRECTIONS].sort((a, b) => b.dot(to) - a.dot(to));

const from = (target: Vector3, direction: Vector3, away: number): Viewpoint => ({
  position: target.clone().addScaledVector(direction, away).toArray(),
  target: target.toArray(),
});

/**
 * The camera turned as little as possible to see a point: around its target, or around the point if the former cannot show it. Null if the
 * point is already visible.
 *
 * @param outward unit vector out of the model at the point; into it, for an inverted file
 * @param isSeen returns true if the point is unobstructed from a viewpoint and inside the view
 */
export function sighted(now: Viewpoint, point: Vector3, outward: Vector3, isSeen: (from: Viewpoint) => boolean): Viewpoint | null {
  if (isSeen(now)) return null;
  const middle = new Vector3(...now.target);
  const look = new Vector3(...now.position).sub(middle);
  const away = look.length();
  for (const target of [middle, point]) {
    for (const direction of nearest(look)) {
      const to = from(target, direction, away);
      const cosine = new Vector3(...to.position).sub(point).normalize().dot(outward);
      if (Math.abs(cosine) >= LEAST_COSINE && isSeen(to)) return to;
    }
  }
  // Hidden from everywhere, as in a cavity: at least face the point.
  return from(point, nearest(outward)[0] ?? outward, away);
}
