/** Distances of the stair steps from the model's surface. */
import { Box3, Vector3 } from "three";
import type { Solid } from "./contours.js";
import { nearestOf } from "./nearest.js";
import { Refinement, type MeasuredPart, type Ruler } from "./refinement.js";
import { shallowOf } from "./shallow.js";
import type { Steps, StepsPart } from "./steps.js";
import { shared } from "./work.js";

export interface MeasuredSteps extends Steps {
  readonly parts: readonly MeasuredPart[];
  /** Largest distance found, mm. */
  readonly greatest_mm: number;
}

export const isMeasured = (steps: Steps | null): steps is MeasuredSteps => steps !== null && "greatest_mm" in steps;

/** Fractions of the progress: sorting the facets, finding shallow ones, and the corners of each part. */
const SORTING = 0.1;
const PREPARING = 0.15;
const CORNERS = 0.5;

/** Corners that share a query of nearby facets; a larger group would gather facets that are near few of its corners. */
const GROUP = 32;

/** Longest side of the box around such a group, as a fraction of the model's longest side. */
const GROUP_PART = 1 / 64;

/** Minimum length of an edge to split, as a fraction of the model's longest side: a few pixels. */
const FINEST_PART = 1 / 128;

/** Bound of the effect of rounded coordinates on a distance, as a fraction of the model's longest side. */
const ROUNDING = 1e-6;

/** Triangles between two yields. */
const BLOCK = 32;

/** Longest side of the points' bounds, mm. */
function longestSide(points: Float32Array): number {
  return Math.max(...new Box3().setFromArray(points).getSize(new Vector3()).toArray());
}

/** Height of the thickest layer, mm. */
function thickest(parts: readonly StepsPart[]): number {
  let most = 0;
  for (const { positions } of parts) {
    for (let at = 2; at < positions.length; at += 6) most = Math.max(most, (positions[at + 3] ?? 0) - (positions[at] ?? 0));
  }
  return most;
}

/** Measures the corners of a part, which come in pairs: the bottom and the top of a wall. Yields after each group. */
function* cornersOf({ positions }: StepsPart, size_mm: number, { nearest, rounding_mm }: Ruler): Generator<number, Float32Array> {
  const count = positions.length / 3;
  const away = new Float32Array(count);
  const side = GROUP_PART * size_mm;
  const box = new Box3();
  const [bottom, top] = [new Vector3(), new Vector3()];
  for (let first = 0; first < count; ) {
    yield first / count;
    box.makeEmpty();
    let reach = 0;
    let end = first;
    for (; end < count && end - first < GROUP; end += 2) {
      bottom.fromArray(positions, 3 * end);
      top.fromArray(positions, 3 * end + 3);
      const isFar =
        Math.max(box.max.x, bottom.x) - Math.min(box.min.x, bottom.x) > side ||
        Math.max(box.max.y, bottom.y) - Math.min(box.min.y, bottom.y) > side;
      if (end > first && isFar) break;
      box.expandByPoint(bottom).expandByPoint(top);
      // At half its height, the wall follows the contour, which is on the model, so no corner is farther away than half the height.
      reach = Math.max(reach, (top.z - bottom.z) / 2 + rounding_mm);
    }
    nearest.gather(box, reach);
    for (; first < end; first++) {
      const at = 3 * first;
      const away_mm = nearest.distance(positions[at] ?? 0, positions[at + 1] ?? 0, positions[at + 2] ?? 0, reach);
      away[first] = away_mm > rounding_mm ? away_mm : 0;
    }
  }
  return away;
}

/** Splits a part where interpolation between its corners is not accurate enough. */
function* refined(part: StepsPart, away_mm: Float32Array, ruler: Ruler): Generator<number, Refinement> {
  const { positions, index } = part;
  const out = new Refinement(part, away_mm, ruler);
  for (let at = 0; at < index.length; ) {
    if (at % (3 * BLOCK) === 0) yield at / index.length;
    const [a, b, c] = [index[at] ?? 0, index[at + 1] ?? 0, index[at + 2] ?? 0];
    if (positions[3 * a + 2] === positions[3 * c + 2]) {
      out.tread(a, b, c);
      at += 3;
    } else {
      // Two triangles of a wall: the first has two corners at the bottom, and each is followed by the corner at its top.
      out.wall(a, a + 1, b, b + 1);
      at += 6;
    }
  }
  return out;
}

/** Prepares the model for measuring these steps. */
function* rulerOf(solid: Solid, size_mm: number, steps: Steps): Generator<number, Ruler> {
  const finest_mm = FINEST_PART * size_mm;
  const rounding_mm = ROUNDING * size_mm;
  const reach_mm = thickest(steps.parts) / 2 + steps.tolerance_mm;
  const nearest = yield* shared(nearestOf(solid), 0, SORTING);
  const shallow = yield* shared(shallowOf(solid, finest_mm, reach_mm), SORTING, PREPARING);
  const contour_mm = 2 * steps.tolerance_mm + rounding_mm;
  return { nearest, shallow, reach_mm, finest_mm, contour_mm, rounding_mm };
}

/**
 * Measures the stair steps of a model: each corner, and additional corners where interpolation is not accurate enough. Facets hidden inside
 * other bodies also count. Walls that close a hole of the mesh have no facet nearby, and are drawn as half a thickest layer away. Yields
 * its progress, 0 to 1. Cost: about ten microseconds per corner.
 */
export function* measured(solid: Solid, steps: Steps): Generator<number, MeasuredSteps> {
  const size_mm = longestSide(solid.points);
  const ruler = yield* rulerOf(solid, size_mm, steps);
  const parts: MeasuredPart[] = [];
  let greatest_mm = 0;
  const count = steps.parts.length;
  for (const [i, part] of steps.parts.entries()) {
    const place = (done: number): number => PREPARING + ((1 - PREPARING) * (i + done)) / count;
    const away_mm = yield* shared(cornersOf(part, size_mm, ruler), place(0), place(CORNERS));
    const refinement = yield* shared(refined(part, away_mm, ruler), place(CORNERS), place(1));
    greatest_mm = Math.max(greatest_mm, refinement.greatest_mm);
    parts.push(refinement.done());
  }
  return { ...steps, parts, greatest_mm };
}
