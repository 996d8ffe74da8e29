/** The scale of colours for the thickness of walls. */

/** What the checks take for a thin wall where a shop says nothing, mm. A test holds it to the core's. */
export const WALL_MM = 0.4;

/** The end of the scale as a multiple of that: whoever looks for thin walls need not tell thick ones apart. */
const FULL = 10;

export interface WallScale {
  /** What is thinner than this is marked, mm. */
  readonly least_mm: number;
  /** The upper end of the scale of colours, mm: all that is thicker looks the same. */
  readonly full_mm: number;
}

/** The same for every model, so that they can be compared. */
export const wallScale = (wall_mm: number): WallScale => ({ least_mm: wall_mm, full_mm: FULL * (wall_mm || WALL_MM) });
