/** Facets of a model in slabs, each with a bounding volume hierarchy; a single hierarchy would block the page while it is built. */
import { Box3, BufferAttribute, BufferGeometry, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Solid } from "./contours.js";
import { shared } from "./work.js";

/** Facets between two yields while they are sorted. */
const BLOCK = 8192;

/** Number of bins along the axis for sorting facets. */
const BINS = 4096;

/** Fraction of the progress for sorting. */
const SORTING = 0.25;

export type Axis = 0 | 1 | 2;

/** Facets that are neighbours along an axis, and their bounds. Test the bounds first: a tree traversal costs a microsecond to start. */
export interface Slab {
  readonly bounds: Box3;
  readonly tree: MeshBVH;
}

export interface Slabs {
  /** Three points per facet; the trees refer to facets by their position in it. */
  readonly index: Uint32Array;
  readonly slabs: readonly Slab[];
}

/** Points of the facets in their order along an axis, three numbers per facet. */
function* sorted({ points, topology: { corner } }: Solid, axis: Axis): Generator<number, Uint32Array> {
  const count = corner.length / 3;
  const middle = (facet: number): number => {
    const at = 3 * facet;
    const sum = (points[3 * (corner[at] ?? 0) + axis] ?? 0) + (points[3 * (corner[at + 1] ?? 0) + axis] ?? 0);
    return (sum + (points[3 * (corner[at + 2] ?? 0) + axis] ?? 0)) / 3;
  };
  let [low, high] = [Infinity, -Infinity];
  for (let at = axis; at < points.length; at += 3) {
    low = Math.min(low, points[at] ?? 0);
    high = Math.max(high, points[at] ?? 0);
  }
  const bin = (facet: number): number =>
    Math.min(BINS - 1, Math.max(0, Math.floor((BINS * (middle(facet) - low)) / (high - low || 1))));
  const next = new Uint32Array(BINS + 1);
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield facet / (2 * count);
    const after = bin(facet) + 1;
    next[after] = (next[after] ?? 0) + 1;
  }
  for (let i = 0; i < BINS; i++) next[i + 1] = (next[i + 1] ?? 0) + (next[i] ?? 0);
  const out = new Uint32Array(corner.length);
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield 0.5 + facet / (2 * count);
    const here = bin(facet);
    const to = next[here] ?? 0;
    next[here] = to + 1;
    for (let i = 0; i < 3; i++) out[3 * to + i] = corner[3 * facet + i] ?? 0;
  }
  return out;
}

/**
 * Sorts the facets of a model into slabs across an axis, each of `facets` facets. A hierarchy of 4096 facets takes a few milliseconds to
 * build, during which the page does not respond; on the other hand, each costs a traversal. Yields its progress, 0 to 1.
 */
export function* slabsOf(solid: Solid, axis: Axis, facets: number): Generator<number, Slabs> {
  const { points } = solid;
  const index = yield* shared(sorted(solid, axis), 0, SORTING);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  const slabs: Slab[] = [];
  const point = new Vector3();
  for (let start = 0; start < index.length; start += 3 * facets) {
    const count = Math.min(3 * facets, index.length - start);
    const bounds = new Box3();
    for (let i = start; i < start + count; i++) bounds.expandByPoint(point.fromArray(points, 3 * (index[i] ?? 0)));
    slabs.push({ bounds, tree: new MeshBVH(geometry, { range: { start, count }, setBoundingBox: false }) });
    yield SORTING + ((1 - SORTING) * (start + count)) / index.length;
  }
  return { index, slabs };
}
