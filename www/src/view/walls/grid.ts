/**
 * Where samples are on facets. A facet has a grid of cells: columns along its longest side, rows from there to the corner opposite,
 * in which they end. A facet smaller than the spacing is a single cell, one with long sides many: what is measured at a place
 * inside a cell is right for all of it, where one value a facet, or a corner, would be wrong on the large facets of CAD models.
 */

import { shared } from "../steps/work.js";

/** Facets between two yields. */
const BLOCK = 8192;

/** Most columns or rows of a facet. */
const MOST_CELLS = 2048;

/** Spacing of samples, as a fraction of the model's longest side: three or four pixels of a view that shows all of it. */
const SPACING_PART = 1 / 160;

/** What the spacing grows by where there would be too many samples. */
const COARSER = 1.25;

const ROWS_BIT = 12;
const APEX_BIT = 24;
const CELLS_MASK = (1 << ROWS_BIT) - 1;

export interface Grids {
  /** Two numbers a facet: its first cell; and columns, rows, and which corner is opposite the longest side, as `packed`. */
  readonly grids: Uint32Array;
  /** Cells in all. */
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

/** Corners of facets, three points each of three coordinates, mm. */
export type Corner = (facet: number, corner: number, axis: number) => number;

/** The longest side of each facet, its height on that, and the corner opposite. */
function* shapesOf(count: number, corner: Corner): Generator<number, { long: Float32Array; high: Float32Array; apex: Uint8Array }> {
  const out = { long: new Float32Array(count), high: new Float32Array(count), apex: new Uint8Array(count) };
  const side = new Float64Array(9);
  for (let facet = 0; facet < count; facet++) {
    if (facet % BLOCK === 0) yield facet / count;
    let [apex, longest] = [0, -1];
    for (let i = 0; i < 3; i++) {
      // Opposite corner i.
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
 * Divides the facets of a model whose longest side is `size_mm` into cells, of which there are at most `more` besides one a facet.
 * Yields its progress, 0 to 1.
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

/** A place in a cell: `u` and `v`, 0 to 1, are how far it is across the cell and up. A single row's is nearer its wide side. */
export function placeIn({ columns, rows }: Grid, column: number, row: number, u: number, v: number): Weights {
  const up = rows === 1 ? (2 / 3) * v : (row + v) / rows;
  const across = (column + u) / columns;
  return [up, (1 - up) * (1 - across), (1 - up) * across];
}
