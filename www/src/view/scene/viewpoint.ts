/** Position and target of a camera, and interpolation between two viewpoints. */
import type { Triple } from "./pose.js";

export interface Viewpoint {
  readonly position: Triple;
  readonly target: Triple;
}

/** Duration of a camera flight, ms. */
export const FLIGHT_MS = 450;

/** Easing from 0 to 1 with a gentle start and stop. */
export const eased = (part: number): number => (part < 0.5 ? 4 * part ** 3 : 1 - (2 - 2 * part) ** 3 / 2);

const mix = (a: number, b: number, part: number): number => a + (b - a) * part;

/** Distance from the target, angle from straight above, and angle about z. */
function polar({ position, target }: Viewpoint): Triple {
  const [x, y, z] = [position[0] - target[0], position[1] - target[1], position[2] - target[2]];
  const distance = Math.hypot(x, y, z);
  return [distance, Math.acos(z / distance), Math.atan2(y, x)];
}

/**
 * Viewpoint at fraction `part` of the way, 0 to 1. The camera turns about z the shorter way. Its distance changes exponentially in time,
 * and its target in proportion to the distance, so that both arrive together on the screen.
 */
export function between(from: Viewpoint, to: Viewpoint, part: number): Viewpoint {
  const [r0, polar0, around0] = polar(from);
  const [r1, polar1, around1] = polar(to);
  const r = r0 * (r1 / r0) ** part;
  const reached = Math.abs(r1 - r0) < 1e-6 * r0 ? part : (r - r0) / (r1 - r0);
  const tilt = mix(polar0, polar1, part);
  const turn = Math.atan2(Math.sin(around1 - around0), Math.cos(around1 - around0));
  const around = around0 + turn * part;
  const target = [0, 1, 2].map((axis) => mix(from.target[axis] ?? 0, to.target[axis] ?? 0, reached)) as unknown as Triple;
  return {
    target,
    position: [
      target[0] + r * Math.sin(tilt) * Math.cos(around),
      target[1] + r * Math.sin(tilt) * Math.sin(around),
      target[2] + r * Math.cos(tilt),
    ],
  };
}

/** Returns true if two viewpoints are equal up to rounding. */
export function areSame(a: Viewpoint, b: Viewpoint): boolean {
  const near = 1e-4 * polar(a)[0];
  return [0, 1, 2].every(
    (axis) =>
      Math.abs((a.position[axis] ?? 0) - (b.position[axis] ?? 0)) < near && Math.abs((a.target[axis] ?? 0) - (b.target[axis] ?? 0)) < near,
  );
}
