/** Distances from points to the nearest facet of a model, by bounding volume hierarchies. */
import { Box3, Triangle, Vector3 } from "three";
import type { Solid } from "./contours.js";
import { slabsOf, type Slab } from "./slabs.js";

/** Smaller distances count as on the facet, mm; below the resolution of coordinates. */
const ON_FACET_MM = 1e-6;

/** The axis of heights. */
const HEIGHT = 2;

/** Facets per hierarchy. */
const SLAB_FACETS = 4096;

/** With fewer gathered facets than this, the margin around the box grows; with more than the other, it shrinks. */
const FEW = 16;
const MANY = 48;

/**
 * Distance queries to the facets of a model. Points near one another share a traversal of the hierarchies: first `gather` the facets around
 * them, then measure each point.
 */
export class Nearest {
  readonly #points: Float32Array;
  readonly #index: Uint32Array;
  readonly #slabs: readonly Slab[];
  /** Indices of the gathered facets, and the bounds of each: three minimum and three maximum coordinates. */
  readonly #gathered: number[] = [];
  readonly #bounds: number[] = [];
  /** Box requested, and box gathered. */
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
   * Collects the facets with bounds within `reach_mm` of a box, unless the last call did already. The next box is often near the last, so a
   * margin is added, as large as possible for a few more facets.
   */
  gather(box: Box3, reach_mm: number): void {
    this.#wanted.copy(box).expandByScalar(reach_mm);
    if (this.#around.containsBox(this.#wanted)) return;
    if (this.#gathered.length < FEW) this.#room_mm = Math.max(2 * this.#room_mm, reach_mm);
    else if (this.#gathered.length > MANY) this.#room_mm /= 2;
    this.#gathered.length = this.#bounds.length = 0;
    const around = this.#around.copy(this.#wanted).expandByScalar(this.#room_mm);
    for (const { bounds: slab, tree } of this.#slabs) {
      if (!slab.intersectsBox(around)) continue;
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
   * Distance of a point to the nearest gathered facet, mm; `most_mm` if all are farther away. Facets hidden inside other bodies also count.
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

/** Distance of a value outside a range; 0 inside. */
const outside = (value: number, least: number, greatest: number): number => Math.max(least - value, value - greatest, 0);

/** Prepares a model for distance queries. Yields its progress, 0 to 1. */
export function* nearestOf(solid: Solid): Generator<number, Nearest> {
  const { index, slabs } = yield* slabsOf(solid, HEIGHT, SLAB_FACETS);
  return new Nearest(solid.points, index, slabs);
}
