/** Helpers for tests of the stair steps. */
import type { Solid } from "./contours.js";
import { posed, UPRIGHT } from "../scene/pose.js";
import { topologyOf } from "../scene/topology.js";

/** The result of a generator of progress values. */
export function finished<Result>(work: Generator<unknown, Result>): Result {
  for (;;) {
    const step = work.next();
    if (step.done === true) return step.value;
  }
}

/** A model on the plate. */
export function solid(positions: Float32Array, rotation = UPRIGHT): Solid {
  const topology = finished(topologyOf(positions));
  return { points: posed(topology.points, rotation, 1), topology };
}

/** Boundaries of layers of `thickness_mm`; the last one has the rest. */
export function layers(height: number, thickness_mm: number): number[] {
  const out = [0];
  while ((out.at(-1) ?? 0) < height - 1e-9) out.push(Math.min(height, (out.at(-1) ?? 0) + thickness_mm));
  return out;
}
