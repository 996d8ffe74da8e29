/** Regions of a model so shallow that their treads are wide. */
import type { Solid } from "./contours.js";

/** Facets between two yields. */
const BLOCK = 2048;

/** Grid whose cells around shallow facets are marked: a quick test for one near a point. */
export class Shallow {
  readonly #cell_mm: number;
  readonly #least: readonly number[];
  readonly #count: readonly number[];
  readonly #marks: Uint8Array;

  constructor(points: Float32Array, cell_mm: number) {
    const [least, greatest] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let at = 0; at < points.length; at++) {
      const value = points[at] ?? 0;
      least[at % 3] = Math.min(least[at % 3] ?? value, value);
      greatest[at % 3] = Math.max(greatest[at % 3] ?? value, value);
    }
    this.#cell_mm = cell_mm;
    this.#least = least;
    this.#count = least.map((from, axis) => Math.floor(((greatest[axis] ?? from) - from) / cell_mm) + 1);
    this.#marks = new Uint8Array(this.#count.reduce((product, count) => product * count, 1));
  }

  has(x: number, y: number, z: number): boolean {
    return this.#marks[this.#at(this.#cell(x, 0), this.#cell(y, 1), this.#cell(z, 2))] === 1;
  }

  /** Marks the cells of a box. */
  mark(least: readonly number[], greatest: readonly number[]): void {
    const [x0 = 0, y0 = 0, z0 = 0] = least.map((value, axis) => this.#cell(value, axis));
    const [x1 = 0, y1 = 0, z1 = 0] = greatest.map((value, axis) => this.#cell(value, axis));
    for (let z = z0; z <= z1; z++) {
      for (let y = y0; y <= y1; y++) this.#marks.fill(1, this.#at(x0, y, z), this.#at(x1, y, z) + 1);
    }
  }

  /** Cell of a coordinate, clamped to the grid. */
  #cell(value: number, axis: number): number {
    const cell = Math.floor((value - (this.#least[axis] ?? 0)) / this.#cell_mm);
    return Math.min((this.#count[axis] ?? 1) - 1, Math.max(0, cell));
  }

  #at(x: number, y: number, z: number): number {
    return x + (this.#count[0] ?? 1) * (y + (this.#count[1] ?? 1) * z);
  }
}

/**
 * Marks the cells within `reach_mm` of a facet that rises by less than 2 `reach_mm`, a layer's thickness, over `cell_mm`. Yields its
 * progress, 0 to 1.
 */
export function* shallowOf({ points, topology: { corner } }: Solid, cell_mm: number, reach_mm: number): Generator<number, Shallow> {
  const out = new Shallow(points, cell_mm);
  const value = (at: number, axis: number): number => points[3 * (corner[at] ?? 0) + axis] ?? 0;
  for (let at = 0; at < corner.length; at += 3) {
    if (at % (3 * BLOCK) === 0) yield at / corner.length;
    const [ux, uy, uz] = [value(at + 1, 0) - value(at, 0), value(at + 1, 1) - value(at, 1), value(at + 1, 2) - value(at, 2)];
    const [vx, vy, vz] = [value(at + 2, 0) - value(at, 0), value(at + 2, 1) - value(at, 1), value(at + 2, 2) - value(at, 2)];
    const [normalX, normalY, normalZ] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    if (cell_mm ** 2 * (normalX ** 2 + normalY ** 2) > (2 * reach_mm * normalZ) ** 2) continue;
    const least = [0, 1, 2].map((axis) => Math.min(value(at, axis), value(at + 1, axis), value(at + 2, axis)) - reach_mm);
    const greatest = [0, 1, 2].map((axis) => Math.max(value(at, axis), value(at + 1, axis), value(at + 2, axis)) + reach_mm);
    out.mark(least, greatest);
  }
  return out;
}
