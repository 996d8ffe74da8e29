/** Cross-sections of a closed mesh, traced from facet to facet. */
import { after, type Topology } from "../scene/topology.js";

/**
 * Closed polyline as x and y of its points, mm; the end joins the start. The inside of the model is on its left, so outlines run
 * counter-clockwise and holes clockwise.
 */
export type Contour = readonly number[];

/** A model on the plate: its posed points, and its topology. */
export interface Solid {
  /** Three numbers each, mm, z up from the plate. */
  readonly points: Float32Array;
  readonly topology: Pick<Topology, "corner" | "twin">;
}

/** Facets cut by each plane, in one array, and the start of each plane's range. */
export interface Cuts {
  readonly facets: Uint32Array;
  /** One entry more than there are planes. */
  readonly start: Uint32Array;
}

/** Facets between two yields. */
const BLOCK = 8192;

/** Number of the ascending `values` that are less than `value`. */
function countBelow(values: readonly number[], value: number): number {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((values[middle] ?? 0) < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/**
 * Finds the facets that each plane cuts. A point on a plane counts as below it, so a facet is cut by the planes from its lowest point up
 * to, but not including, its highest.
 *
 * @param planes_mm heights, ascending
 */
export function* cutsOf({ points, topology }: Solid, planes_mm: readonly number[]): Generator<number, Cuts> {
  const { corner } = topology;
  const count = corner.length / 3;
  const start = new Uint32Array(planes_mm.length + 1);
  // First plane of each facet and the one after its last, used for both counting and filling.
  const range = new Uint32Array(2 * count);
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield facet / count;
    const a = points[3 * (corner[3 * facet] ?? 0) + 2] ?? 0;
    const b = points[3 * (corner[3 * facet + 1] ?? 0) + 2] ?? 0;
    const c = points[3 * (corner[3 * facet + 2] ?? 0) + 2] ?? 0;
    const lowest = a < b ? (a < c ? a : c) : b < c ? b : c;
    const highest = a > b ? (a > c ? a : c) : b > c ? b : c;
    const first = countBelow(planes_mm, lowest);
    const last = countBelow(planes_mm, highest);
    range[2 * facet] = first;
    range[2 * facet + 1] = last;
    for (let plane = first; plane < last; plane++) start[plane + 1] = (start[plane + 1] ?? 0) + 1;
  }
  for (let plane = 0; plane < planes_mm.length; plane++) start[plane + 1] = (start[plane + 1] ?? 0) + (start[plane] ?? 0);
  const facets = new Uint32Array(start[planes_mm.length] ?? 0);
  const next = start.slice();
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield facet / count;
    for (let plane = range[2 * facet] ?? 0; plane < (range[2 * facet + 1] ?? 0); plane++) {
      const at = next[plane] ?? 0;
      facets[at] = facet;
      next[plane] = at + 1;
    }
  }
  return { facets, start };
}

/** Traces the contours of a plane, given the facets that it cuts. Must be called for one plane after another. */
export type Tracer = (z_mm: number, facets: Uint32Array) => Contour[];

/**
 * Returns a tracer, which holds state shared between planes. Where the mesh is open, a straight line joins the ends. Points are omitted as
 * long as the contour stays within `tolerance_mm` of them. Cost per plane: linear in the facets that it cuts.
 */
export function tracer({ points, topology }: Solid, tolerance_mm: number): Tracer {
  const { corner, twin } = topology;
  // Last plane whose contour passed each facet; saves clearing a set for each plane.
  const seen = new Uint32Array(corner.length / 3);
  let plane = 0;
  const height = (halfEdge: number): number => points[3 * (corner[halfEdge] ?? 0) + 2] ?? 0;

  /** The half-edge of the facet that crosses the plane, upwards or downwards. */
  const crossing = (facet: number, z: number, upwards: boolean): number => {
    for (let edge = 3 * facet; edge < 3 * facet + 3; edge++) {
      const from = height(edge) > z;
      const to = height(after(edge)) > z;
      if (from !== to && to === upwards) return edge;
    }
    return -1;
  };

  /** Appends the intersection of a half-edge with the plane, computed from its lower end so that both facets get the same point. */
  const meet = (edge: number, z: number, into: number[]): void => {
    const one = 3 * (corner[edge] ?? 0);
    const other = 3 * (corner[after(edge)] ?? 0);
    const isUpwards = (points[one + 2] ?? 0) < (points[other + 2] ?? 0);
    const low = isUpwards ? one : other;
    const high = isUpwards ? other : one;
    const bottom = points[low + 2] ?? 0;
    const part = (z - bottom) / ((points[high + 2] ?? 0) - bottom);
    for (let axis = 0; axis < 2; axis++) {
      const from = points[low + axis] ?? 0;
      into.push(from + part * ((points[high + axis] ?? 0) - from));
    }
  };

  /** Walks from facet to facet; returns false at an open edge, true when the contour closes. */
  const walk = (from: number, z: number, upwards: boolean, into: number[]): boolean => {
    let facet = from;
    for (;;) {
      const edge = crossing(facet, z, upwards);
      if (edge < 0) return false;
      meet(edge, z, into);
      const other = twin[edge] ?? -1;
      if (other < 0) return false;
      facet = Math.floor(other / 3);
      if (seen[facet] === plane) return true;
      seen[facet] = plane;
    }
  };

  return (z, facets) => {
    plane++;
    const contours: Contour[] = [];
    for (const facet of facets) {
      if (seen[facet] === plane) continue;
      seen[facet] = plane;
      const forwards: number[] = [];
      // With the inside on its left, a contour leaves each facet by the edge that runs upwards.
      const closed = walk(facet, z, true, forwards);
      const contour = closed ? forwards : joined(backwards(facet, z), forwards);
      const kept = simplified(contour, tolerance_mm);
      if (kept.length >= 6) contours.push(kept);
    }
    return contours;
  };

  function backwards(facet: number, z: number): number[] {
    const out: number[] = [];
    walk(facet, z, false, out);
    return out;
  }
}

/** Joins the points found backwards, which are in reverse order, with those found forwards. */
function joined(before: readonly number[], behind: readonly number[]): number[] {
  const out: number[] = [];
  for (let i = before.length - 2; i >= 0; i -= 2) out.push(before[i] ?? 0, before[i + 1] ?? 0);
  out.push(...behind);
  return out;
}

/** Maximum number of points omitted in a row, since each is checked again for every further one. */
const RUN_LIMIT = 32;

/** Index of the leftmost point, the lowest of several; it is certainly a corner. */
function leftmost(contour: Contour): number {
  let found = 0;
  for (let i = 2; i < contour.length; i += 2) {
    const across = (contour[i] ?? 0) - (contour[found] ?? 0);
    if (across < 0 || (across === 0 && (contour[i + 1] ?? 0) < (contour[found + 1] ?? 0))) found = i;
  }
  return found / 2;
}

/** Omits points as long as all of them stay within the tolerance of the line that replaces them. */
export function simplified(contour: Contour, tolerance_mm: number): Contour {
  const count = contour.length / 2;
  const start = leftmost(contour);
  const x = (i: number): number => contour[2 * ((start + i) % count)] ?? 0;
  const y = (i: number): number => contour[2 * ((start + i) % count) + 1] ?? 0;

  /** Returns true if the points strictly between two lie on the segment that joins the two. */
  const areOnLine = (from: number, to: number): boolean => {
    const [dx, dy] = [x(to) - x(from), y(to) - y(from)];
    const length = Math.hypot(dx, dy);
    if (!(length > 0)) return false;
    for (let i = from + 1; i < to; i++) {
      const px = x(i) - x(from);
      const py = y(i) - y(from);
      const along = (px * dx + py * dy) / length;
      if (Math.abs(px * dy - py * dx) > tolerance_mm * length || along < -tolerance_mm || along > length + tolerance_mm) {
        return false;
      }
    }
    return true;
  };

  const out: number[] = [];
  let kept = 0;
  for (let i = 0; i < count; i++) {
    if (i > 0 && i - kept < RUN_LIMIT && areOnLine(kept, i + 1)) continue;
    out.push(x(i), y(i));
    kept = i;
  }
  return out;
}

/** Area inside a contour, mm²; negative for a hole. */
export function signedArea(contour: Contour): number {
  let doubled = 0;
  const count = contour.length;
  for (let i = 0; i < count; i += 2) {
    const next = (i + 2) % count;
    doubled += (contour[i] ?? 0) * (contour[next + 1] ?? 0) - (contour[next] ?? 0) * (contour[i + 1] ?? 0);
  }
  return doubled / 2;
}
