/** From where a point of the model is seen. */
import { Vector3 } from "three";
import type { Viewpoint } from "../scene/viewpoint.js";

/** Between the directions that are tried, radians. */
const STEP = Math.PI / 12;

/** The cosine of the flattest look at the surface: a marker at its edge is hardly seen. */
const LEAST_COSINE = 0.25;

/** All around, and no steeper than 60°: there nobody knows any more which side is the front. */
const DIRECTIONS: readonly Vector3[] = Array.from({ length: 9 }, (_, row) => (row - 4) * STEP).flatMap((up) =>
  Array.from({ length: 24 }, (_, column) => new Vector3(Math.cos(column * STEP), Math.sin(column * STEP), 0).multiplyScalar(Math.cos(up)).setZ(Math.sin(up))),
);

/** The nearest to a direction first. */
const nearest = (to: Vector3): Vector3[] => [...DIRECTIONS].sort((a, b) => b.dot(to) - a.dot(to));

const from = (target: Vector3, direction: Vector3, away: number): Viewpoint => ({
  position: target.clone().addScaledVector(direction, away).toArray(),
  target: target.toArray(),
});

/**
 * The camera turned as little as possible, so that it sees a point: about what it looks at, or about the point, where it would be out
 * of its sight otherwise. Null if it sees it as it is.
 *
 * @param outward unit vector away from the model at the point; into it, for a file that is inside out
 * @param isSeen whether nothing hides the point from a place, and the view has it
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
  // Hidden from everywhere, as in a cavity: the camera is at least before it.
  return from(point, nearest(outward)[0] ?? outward, away);
}
