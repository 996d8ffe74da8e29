/** Distance from a point on a model's surface through the solid to the exit of a ray. */
import type { Box3 } from "three";
import type { Slabs } from "../steps/slabs.js";

/** Hits closer together than this fraction of the model's size are merged, so that touching bodies form one wall. */
const SAME_PART = 1e-6;

/** Replaces a zero component, which has no inverse. */
const TINY = 1e-30;

/**
 * Rays through a model. Inside is a non-zero winding number, as in the slicer: overlapping bodies are a union, and an inverted body is a
 * cavity in another, but solid by itself.
 */
export class Crossings {
  readonly #points: Float32Array;
  readonly #index: Uint32Array;
  readonly #slabs: Slabs["slabs"];
  readonly #same_mm: number;
  /** Hits of a ray in order: their distances, and 1 where the ray leaves or −1 where it enters a body. */
  readonly #at_mm: number[] = [];
  readonly #out: number[] = [];
  #ox = 0;
  #oy = 0;
  #oz = 0;
  #dx = 0;
  #dy = 0;
  #dz = 0;
  /** Inverse of the direction. */
  #ix = 0;
  #iy = 0;
  #iz = 0;

  constructor(points: Float32Array, { index, slabs }: Slabs, size_mm: number) {
    this.#points = points;
    this.#index = index;
    this.#slabs = slabs;
    this.#same_mm = SAME_PART * size_mm;
  }

  /**
   * Distance in mm from a point on a facet along a unit vector to the end of the solid; null if the solid is not in this direction. Hits at
   * the point itself are ignored.
   */
  through(ox: number, oy: number, oz: number, dx: number, dy: number, dz: number): number | null {
    [this.#ox, this.#oy, this.#oz] = [ox, oy, oz];
    [this.#dx, this.#dy, this.#dz] = [dx, dy, dz];
    [this.#ix, this.#iy, this.#iz] = [1 / (dx || TINY), 1 / (dy || TINY), 1 / (dz || TINY)];
    this.#at_mm.length = this.#out.length = 0;
    for (const { bounds, tree } of this.#slabs) if (this.#meets(bounds)) tree.shapecast(this.#walk);
    // The winding number is zero far away, so the sum over the hits is that at the point.
    let winding = 0;
    for (const out of this.#out) winding += out;
    if (winding === 0) return null;
    for (let i = 0; i < this.#out.length; i++) {
      winding -= this.#out[i] ?? 0;
      const at_mm = this.#at_mm[i] ?? 0;
      if (winding === 0 && !((this.#at_mm[i + 1] ?? Infinity) - at_mm <= this.#same_mm)) return at_mm;
    }
    return null;
  }

  readonly #meets = ({ min, max }: Box3): boolean => {
    const x0 = (min.x - this.#ox) * this.#ix;
    const x1 = (max.x - this.#ox) * this.#ix;
    const y0 = (min.y - this.#oy) * this.#iy;
    const y1 = (max.y - this.#oy) * this.#iy;
    const z0 = (min.z - this.#oz) * this.#iz;
    const z1 = (max.z - this.#oz) * this.#iz;
    const near = Math.max(0, Math.min(x0, x1), Math.min(y0, y1), Math.min(z0, z1));
    return near <= Math.min(Math.max(x0, x1), Math.max(y0, y1), Math.max(z0, z1));
  };

  readonly #walk = {
    intersectsBounds: this.#meets,
    intersectsRange: (first: number, count: number): boolean => {
      for (let facet = first; facet < first + count; facet++) this.#meet(facet);
      return false;
    },
  };

  /** Möller and Trumbore, Fast, minimum storage ray/triangle intersection (1997). */
  #meet(facet: number): void {
    const points = this.#points;
    const a = 3 * (this.#index[3 * facet] ?? 0);
    const b = 3 * (this.#index[3 * facet + 1] ?? 0);
    const c = 3 * (this.#index[3 * facet + 2] ?? 0);
    const ax = points[a] ?? 0;
    const ay = points[a + 1] ?? 0;
    const az = points[a + 2] ?? 0;
    const ux = (points[b] ?? 0) - ax;
    const uy = (points[b + 1] ?? 0) - ay;
    const uz = (points[b + 2] ?? 0) - az;
    const vx = (points[c] ?? 0) - ax;
    const vy = (points[c + 1] ?? 0) - ay;
    const vz = (points[c + 2] ?? 0) - az;
    const px = this.#dy * vz - this.#dz * vy;
    const py = this.#dz * vx - this.#dx * vz;
    const pz = this.#dx * vy - this.#dy * vx;
    const facing = ux * px + uy * py + uz * pz;
    if (facing === 0) return;
    const tx = this.#ox - ax;
    const ty = this.#oy - ay;
    const tz = this.#oz - az;
    const u = (tx * px + ty * py + tz * pz) / facing;
    if (!(u >= 0 && u <= 1)) return;
    const qx = ty * uz - tz * uy;
    const qy = tz * ux - tx * uz;
    const qz = tx * uy - ty * ux;
    const v = (this.#dx * qx + this.#dy * qy + this.#dz * qz) / facing;
    if (!(v >= 0 && u + v <= 1)) return;
    const at_mm = (vx * qx + vy * qy + vz * qz) / facing;
    if (at_mm > this.#same_mm) this.#keep(at_mm, facing > 0 ? -1 : 1);
  }

  #keep(at_mm: number, out: number): void {
    let i = this.#at_mm.length;
    for (; i > 0 && (this.#at_mm[i - 1] ?? 0) > at_mm; i--) {
      this.#at_mm[i] = this.#at_mm[i - 1] ?? 0;
      this.#out[i] = this.#out[i - 1] ?? 0;
    }
    this.#at_mm[i] = at_mm;
    this.#out[i] = out;
  }
}
