/** Splits triangles of the stair steps where distances cannot be interpolated from their corners. */
import { Box3, Vector3 } from "three";
import { Growing } from "./growing.js";
import type { Nearest } from "./nearest.js";
import type { Shallow } from "./shallow.js";
import type { StepsPart } from "./steps.js";

/** A part of the stair steps with its distances from the model. */
export interface MeasuredPart extends StepsPart {
  /** Distance of each corner to the nearest facet of the model, mm; 0 if within rounding. */
  readonly away_mm: Float32Array;
}

/** Tolerance of an interpolated distance, as a fraction of the reach. */
const ALIKE_PART = 1 / 12;

export interface Ruler {
  readonly nearest: Nearest;
  readonly shallow: Shallow;
  /** Half the thickest layer, mm: no point on the outside of the steps is farther from the model. */
  readonly reach_mm: number;
  /** Shorter edges are not split, mm. */
  readonly finest_mm: number;
  /** Maximum distance of contours from the model, mm. */
  readonly contour_mm: number;
  /** Distances up to this are rounding, mm. */
  readonly rounding_mm: number;
}

const point = new Vector3();
const box = new Box3();

/** Distance of a point to the nearest facet, mm; 0 if within rounding, the reach if all facets are farther away. */
function measure({ nearest, reach_mm, rounding_mm }: Ruler, x: number, y: number, z: number): number {
  point.set(x, y, z);
  nearest.gather(box.set(point, point), reach_mm);
  const away_mm = nearest.distance(x, y, z, reach_mm);
  return away_mm > rounding_mm ? away_mm : 0;
}

/** A place with its distance: x, y, z and mm. */
type Place = readonly [x: number, y: number, z: number, away_mm: number];

/** Key of an undirected edge. */
const edge = (a: number, b: number): number => Math.min(a, b) * 2 ** 26 + Math.max(a, b);

/** A part with its distances, and its new corners and triangles. Call `wall` for the walls around a tread first. */
export class Refinement {
  /** Largest distance of a wall corner, mm. */
  greatest_mm = 0;
  readonly #part: StepsPart;
  readonly #away_mm: Float32Array;
  readonly #ruler: Ruler;
  readonly #alike_mm: number;
  /** Coordinates and distance of each added corner. */
  readonly #added: number[] = [];
  readonly #index = new Growing((length) => new Uint32Array(length));
  /** The corner in the middle of each split wall edge. */
  readonly #split = new Map<number, number>();

  constructor(part: StepsPart, away_mm: Float32Array, ruler: Ruler) {
    this.#part = part;
    this.#away_mm = away_mm;
    this.#ruler = ruler;
    this.#alike_mm = ALIKE_PART * ruler.reach_mm;
    for (const away of away_mm) this.greatest_mm = Math.max(this.greatest_mm, away);
  }

  /** Adds a rectangle, given by the bottom and top of one end and of the other. */
  wall(bottom: number, top: number, nextBottom: number, nextTop: number): void {
    const { finest_mm } = this.#ruler;
    if (this.#length(bottom, nextBottom) > finest_mm) {
      const [low, high] = [this.#middle(bottom, nextBottom), this.#middle(top, nextTop)];
      if (!this.#isAlike(low, bottom, nextBottom) || !this.#isAlike(high, top, nextTop)) {
        const [middle, above] = [this.#add(low), this.#add(high)];
        // Half-way up, a wall is on the model, unless it closes a hole, where no distance applies.
        const isOnModel = this.#middle(bottom, nextTop)[3] <= this.#ruler.contour_mm;
        if (isOnModel) this.greatest_mm = Math.max(this.greatest_mm, low[3], high[3]);
        this.#split.set(edge(bottom, nextBottom), middle).set(edge(top, nextTop), above);
        this.wall(bottom, top, middle, above);
        this.wall(middle, above, nextBottom, nextTop);
        return;
      }
    }
    if (this.#length(bottom, top) > finest_mm) {
      const [here, there] = [this.#middle(bottom, top), this.#middle(nextBottom, nextTop)];
      if (!this.#isAlike(here, bottom, top) || !this.#isAlike(there, nextBottom, nextTop)) {
        const [middle, next] = [this.#add(here), this.#add(there)];
        this.wall(bottom, middle, nextBottom, next);
        this.wall(middle, top, next, nextTop);
        return;
      }
    }
    this.#index.push(bottom, nextBottom, nextTop);
    this.#index.push(bottom, nextTop, top);
  }

  /**
   * Adds a triangle of a tread. Most of a tread is under the layer above, and farther from the model than the outside, so it is not split.
   * Neither are narrow treads: they take the colours of their edges, where the distance is largest.
   */
  tread(a: number, b: number, c: number): void {
    if (this.#split.size > 0) {
      for (const [from, to, opposite] of [[a, b, c], [b, c, a], [c, a, b]] as const) {
        const middle = this.#split.get(edge(from, to));
        if (middle !== undefined) return this.#halve(from, to, opposite, middle);
      }
    }
    const ab = this.#length(a, b);
    const bc = this.#length(b, c);
    const ca = this.#length(c, a);
    if (bc > ab && bc >= ca) this.#flat(b, c, a);
    else if (ca > ab) this.#flat(c, a, b);
    else this.#flat(a, b, c);
  }

  /** The part with all splits; the given arrays if there are none. */
  done(): MeasuredPart {
    const { positions, index } = this.#part;
    const before = this.#away_mm;
    const count = this.#added.length / 4;
    if (count === 0) return { positions, index, away_mm: before };
    const out = { positions: new Float32Array(positions.length + 3 * count), away_mm: new Float32Array(before.length + count) };
    out.positions.set(positions);
    out.away_mm.set(before);
    for (let i = 0; i < count; i++) {
      for (let axis = 0; axis < 3; axis++) out.positions[positions.length + 3 * i + axis] = this.#added[4 * i + axis] ?? 0;
      out.away_mm[before.length + i] = this.#added[4 * i + 3] ?? 0;
    }
    return { ...out, index: this.#index.done() };
  }

  /** Adds a triangle whose longest side is from `a` to `b`. */
  #flat(a: number, b: number, c: number): void {
    const longest_mm = this.#length(a, b);
    if (longest_mm > this.#ruler.finest_mm && this.#differs(a, b, c, longest_mm)) {
      this.#halve(a, b, c, this.#add(this.#outside(this.#middle(a, b), a, b)));
    } else this.#index.push(a, b, c);
  }

  /** A place in the middle of a tread's side. If it is under the layer above, its distance is limited to the maximum on the outside. */
  #outside([x, y, z, away_mm]: Place, a: number, b: number): Place {
    const isUnder = away_mm >= this.#ruler.reach_mm;
    return [x, y, z, isUnder ? (this.#value(a, 3) + this.#value(b, 3)) / 2 : Math.min(away_mm, this.greatest_mm)];
  }

  #halve(a: number, b: number, c: number, middle: number): void {
    this.tread(a, middle, c);
    this.tread(middle, b, c);
  }

  /**
   * Returns true if interpolation is inaccurate somewhere in a triangle with longest side `longest_mm`: at its centre, in the middle of
   * that side, or near a corner, since often only the corners are outside.
   */
  #differs(a: number, b: number, c: number, longest_mm: number): boolean {
    const rest = Math.min(0.25, (0.5 * this.#ruler.finest_mm) / longest_mm);
    const near = 1 - 2 * rest;
    return (
      this.#isOff(a, b, c, 1 / 3, 1 / 3) ||
      this.#isOff(a, b, c, 1 / 2, 1 / 2) ||
      this.#isOff(a, b, c, near, rest) ||
      this.#isOff(a, b, c, rest, near) ||
      this.#isOff(a, b, c, rest, rest)
    );
  }

  /** Returns true if interpolation is inaccurate at the mean of the corners with weights `u` and `v` of the first two. */
  #isOff(a: number, b: number, c: number, u: number, v: number): boolean {
    const { shallow, reach_mm } = this.#ruler;
    const mean = (which: number): number =>
      u * this.#value(a, which) + v * this.#value(b, which) + (1 - u - v) * this.#value(c, which);
    const [x, y, z] = [mean(0), mean(1), mean(2)];
    if (!shallow.has(x, y, z)) return false;
    const away_mm = measure(this.#ruler, x, y, z);
    return away_mm < reach_mm && Math.abs(away_mm - mean(3)) > this.#alike_mm;
  }

  #isAlike([, , , away_mm]: Place, a: number, b: number): boolean {
    return Math.abs(away_mm - (this.#value(a, 3) + this.#value(b, 3)) / 2) <= this.#alike_mm;
  }

  #middle(a: number, b: number): Place {
    const x = (this.#value(a, 0) + this.#value(b, 0)) / 2;
    const y = (this.#value(a, 1) + this.#value(b, 1)) / 2;
    const z = (this.#value(a, 2) + this.#value(b, 2)) / 2;
    return [x, y, z, measure(this.#ruler, x, y, z)];
  }

  #add(place: Place): number {
    this.#added.push(...place);
    return (this.#part.positions.length + (3 * this.#added.length) / 4) / 3 - 1;
  }

  #length(a: number, b: number): number {
    // Runs for every triangle, and hypot is slow.
    const x = this.#value(a, 0) - this.#value(b, 0);
    const y = this.#value(a, 1) - this.#value(b, 1);
    const z = this.#value(a, 2) - this.#value(b, 2);
    return Math.sqrt(x * x + y * y + z * z);
  }

  /** Coordinate 0 to 2 of a corner, or its distance as number 3. */
  #value(corner: number, which: number): number {
    const added = corner - this.#away_mm.length;
    if (added >= 0) return this.#added[4 * added + which] ?? 0;
    return (which === 3 ? this.#away_mm[corner] : this.#part.positions[3 * corner + which]) ?? 0;
  }
}
