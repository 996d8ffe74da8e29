/** Distances from points to the nearest facet of a model, by bounding volume hierarchies. */
import { Box3, BufferAttribute, BufferGeometry, Triangle, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { Solid } from "./contours.js";

/** Facets between two yields while they are sorted. */
const BLOCK = 8192;

/** Facets in a hierarchy: few enough that building it takes only a few milliseconds. */
const SLAB_FACETS = 4096;

/** Heights that facets are sorted into. */
const BINS = 4096;

/** Nearer than this counts as on the facet, mm: less than coordinates resolve. */
const ON_FACET_MM = 1e-6;

/** So many gathered facets are worth more room around the box, or less. */
const FEW = 16;
const MANY = 48;

/** Facets that are neighbours in height, and the heights that they reach. */
interface Slab {
  readonly low: number;
  readonly high: number;
  readonly tree: MeshBVH;
}

/** Points of the facets in order of height, three numbers a facet. */
function* byHeight({ points, topology: { corner } }: Solid): Generator<number, Uint32Array> {
  const count = corner.length / 3;
  const middle = (facet: number): number => {
    const at = 3 * facet;
    const sum = (points[3 * (corner[at] ?? 0) + 2] ?? 0) + (points[3 * (corner[at + 1] ?? 0) + 2] ?? 0);
    return (sum + (points[3 * (corner[at + 2] ?? 0) + 2] ?? 0)) / 3;
  };
  let top = 0;
  for (let at = 2; at < points.length; at += 3) top = Math.max(top, points[at] ?? 0);
  const bin = (facet: number): number => Math.min(BINS - 1, Math.max(0, Math.floor((BINS * middle(facet)) / (top || 1))));
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
 * The facets of a model, to ask for distances. Points near one another share a walk through the hierarchies: first `gather`
 * the facets around them, then measure each point. One hierarchy of all facets would block the page while it is built, so
 * there is one for each slab of heights.
 */
export class Nearest {
  readonly #points: Float32Array;
  readonly #index: Uint32Array;
  readonly #slabs: readonly Slab[];
  /** Numbers of the gathered facets, and the bounds of each: three least and three greatest coordinates. */
  readonly #gathered: number[] = [];
  readonly #bounds: number[] = [];
  /** What was asked for, and what was gathered. */
  readonly #wanted = new Box3();
  #room_mm = 0;
  readonly #around = new Box3();
  readonly #point = new Vector3();
  readonly #on = new Vector3();
  readonly #facet = new Triangle();
  readonly #facetBounds = new Box3();

  constructor(points: Float32Array, index: Uint32Array, slabs: readonly Slab[]) {
    this.#points = points;
    this.#index = index;
    this.#slabs = slabs;
  }

  /**
   * Collects the facets whose bounds are within `reach_mm` of a box, unless the last call did already: the next box is often
   * near the last, so there is as much room around it as takes few facets more.
   */
  gather(box: Box3, reach_mm: number): void {
    this.#wanted.copy(box).expandByScalar(reach_mm);
    if (this.#around.containsBox(this.#wanted)) return;
    if (this.#gathered.length < FEW) this.#room_mm = Math.max(2 * this.#room_mm, reach_mm);
    else if (this.#gathered.length > MANY) this.#room_mm /= 2;
    this.#gathered.length = this.#bounds.length = 0;
    const around = this.#around.copy(this.#wanted).expandByScalar(this.#room_mm);
    for (const { low, high, tree } of this.#slabs) {
      if (low > around.max.z || high < around.min.z) continue;
      tree.shapecast({
        intersectsBounds: (bounds) => bounds.intersectsBox(around),
        intersectsRange: (first, count) => {
          for (let facet = first; facet < first + count; facet++) this.#add(facet);
          return false;
        },
      });
    }
  }

  /**
   * Distance of a point to the nearest of the gathered facets, mm; `most_mm` if all are farther away. Facets hidden inside
   * other bodies count too.
   */
  distance(x: number, y: number, z: number, most_mm: number): number {
    let nearest = most_mm;
    const bounds = this.#bounds;
    this.#point.set(x, y, z);
    for (let i = 0, at = 0; i < this.#gathered.length && nearest > ON_FACET_MM; i++, at += 6) {
      const dx = outside(x, bounds[at] ?? 0, bounds[at + 3] ?? 0);
      const dy = outside(y, bounds[at + 1] ?? 0, bounds[at + 4] ?? 0);
      const dz = outside(z, bounds[at + 2] ?? 0, bounds[at + 5] ?? 0);
      if (dx * dx + dy * dy + dz * dz < nearest * nearest) nearest = Math.min(nearest, this.#toFacet(this.#gathered[i] ?? 0));
    }
    return nearest;
  }

  #add(facet: number): void {
    this.#take(facet);
    const { a, b, c } = this.#facet;
    const bounds = this.#facetBounds.makeEmpty().expandByPoint(a).expandByPoint(b).expandByPoint(c);
    if (!bounds.intersectsBox(this.#around)) return;
    const { min, max } = bounds;
    this.#gathered.push(facet);
    this.#bounds.push(min.x, min.y, min.z, max.x, max.y, max.z);
  }

  #take(facet: number): void {
    const { a, b, c } = this.#facet;
    a.fromArray(this.#points, 3 * (this.#index[3 * facet] ?? 0));
    b.fromArray(this.#points, 3 * (this.#index[3 * facet + 1] ?? 0));
    c.fromArray(this.#points, 3 * (this.#index[3 * facet + 2] ?? 0));
  }

  #toFacet(facet: number): number {
    this.#take(facet);
    return this.#facet.closestPointToPoint(this.#point, this.#on).distanceTo(this.#point);
  }
}

/** How far a value is outside a range. */
const outside = (value: number, least: number, greatest: number): number => Math.max(least - value, value - greatest, 0);

/** Prepares a model for questions of distance. Yields its progress, 0 to 1. */
export function* nearestOf(solid: Solid): Generator<number, Nearest> {
  const { points } = solid;
  const sorting = byHeight(solid);
  let sorted = sorting.next();
  for (; sorted.done !== true; sorted = sorting.next()) yield sorted.value / 4;
  const index = sorted.value;
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  const slabs: Slab[] = [];
  for (let start = 0; start < index.length; start += 3 * SLAB_FACETS) {
    const count = Math.min(3 * SLAB_FACETS, index.length - start);
    let [low, high] = [Infinity, -Infinity];
    for (let i = start; i < start + count; i++) {
      const z = points[3 * (index[i] ?? 0) + 2] ?? 0;
      low = Math.min(low, z);
      high = Math.max(high, z);
    }
    slabs.push({ low, high, tree: new MeshBVH(geometry, { range: { start, count }, setBoundingBox: false }) });
    yield 0.25 + (0.75 * (start + count)) / index.length;
  }
  return new Nearest(points, index, slabs);
}
