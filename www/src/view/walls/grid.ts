/**
 * Positions of samples on facets. A facet has a grid of cells: columns along its longest side, and rows from there to the opposite corner,
 * in which the columns converge. A facet smaller than the spacing is a single cell; long sides get many. A sample represents all of its
 * cell, while one value per facet or corner would be wrong on the large facets of CAD models.
 */

import { shared } from "../steps/work.js";

/** Facets between two yields. */
const BLOCK = 8192;

/** Maximum columns or rows of a facet. */
const MOST_CELLS = 2048;

/** Spacing of samples, as a fraction of the model's longest side: three or four pixels of a view that shows all of it. */
const SPACING_PART = 1 / 160;

/** Factor by which the spacing grows while there are too many samples. */
const COARSER = 1.25;

const ROWS_BIT = 12;
const APEX_BIT = 24;
const CELLS_MASK = (1 << ROWS_BIT) - 1;

export interface Grids {
  /** Two numbers per facet: its first cell, and its grid as `packed`. */
  readonly grids: Uint32Array;
  /** Total number of cells. */
  readonly cells: number;
}

export interface Grid {
  readonly columns: number;
  readonly rows: number;
  /** The corner opposite the longest side, 0 to 2. */
  readonly apex: number;
}

export const packed = ({ columns, rows, apex }: Grid): number => columns | (rows << ROWS_BIT) | (apex << APEX_BIT);

export const unpacked = (grid: number): Grid => ({
  columns: grid & CELLS_MASK,
  rows: (grid >> ROWS_BIT) & CELLS_MASK,
  apex: grid >> APEX_BIT,
});

/** Coordinate of a facet's corner along an axis, mm. */
export type Corner = (facet: number, corner: number, axis: number) => number;

/** Longest side of each facet, the height above it, and the opposite corner. */
function* shapesOf(count: number, corner: Corner): Generator<number, { long: Float32Array; high: Float32Array; apex: Uint8Array }> {
  const out = { long: new Float32Array(count), high: new Float32Array(count), apex: new Uint8Array(count) };
  const side = new Float64Array(9);
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield facet / count;
    let [apex, longest] = [0, -1];
    for (let i = 0; i < 3; i++) {
      // The side opposite corner i.
      for (let axis = 0; axis < 3; axis++) side[3 * i + axis] = corner(facet, (i + 2) % 3, axis) - corner(facet, (i + 1) % 3, axis);
      const [x = 0, y = 0, z = 0] = side.subarray(3 * i, 3 * i + 3);
      const length = Math.sqrt(x * x + y * y + z * z);
      if (length > longest) [apex, longest] = [i, length];
    }
    const [ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0] = side;
    const x = ay * bz - az * by;
    const y = az * bx - ax * bz;
    const z = ax * by - ay * bx;
    out.long[facet] = longest;
    out.high[facet] = longest > 0 ? Math.sqrt(x * x + y * y + z * z) / longest : 0;
    out.apex[facet] = apex;
  }
  return out;
}

/**
 * Divides the facets of a model with longest side `size_mm` into cells, at most `more` in addition to one per facet. Yields its progress, 0
 * to 1.
 */
export function* gridsOf(count: number, corner: Corner, size_mm: number, more: number): Generator<number, Grids> {
  const { long, high, apex } = yield* shared(shapesOf(count, corner), 0, 0.5);
  const along = (length_mm: number, spacing_mm: number): number => Math.min(MOST_CELLS, Math.max(1, Math.ceil(length_mm / spacing_mm - 0.5)));
  let spacing_mm = SPACING_PART * size_mm || 1;
  for (;;) {
    let extra = 0;
    for (let facet = 0; facet < count; facet++) {
      extra += along(long[facet] ?? 0, spacing_mm) * along(high[facet] ?? 0, spacing_mm) - 1;
      if (facet % BLOCK === 0) yield 0.5;
    }
    if (extra <= more) break;
    spacing_mm *= COARSER;
  }
  const grids = new Uint32Array(2 * count);
  let cells = 0;
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield 0.5 + facet / (2 * count);
    const columns = along(long[facet] ?? 0, spacing_mm);
    const rows = along(high[facet] ?? 0, spacing_mm);
    grids[2 * facet] = cells;
    grids[2 * facet + 1] = packed({ columns, rows, apex: apex[facet] ?? 0 });
    cells += columns * rows;
  }
  return { grids, cells };
}

/** Weights of a facet's corners, beginning with the one opposite the longest side. */
export type Weights = readonly [apex: number, from: number, to: number];

/** Position in a cell, given fractions `u` across and `v` up, 0 to 1. A single row is sampled nearer its wide side. */
export function placeIn({ columns, rows }: Grid, column: number, row: number, u: number, v: number): Weights {
  const up = rows === 1 ? (2 / 3) * v : (row + v) / rows;
  const across = (column + u) / columns;
  return [up, (1 - up) * (1 - across), (1 - up) * across];
}
