/** The scale of colours for the thickness of walls. */

/** The end of the scale as a multiple of the limit: thick walls need not be told apart. */
const FULL = 10;

/** The end of the scale without a limit, mm. */
const FULL_MM = 4;

export interface WallScale {
  /** What is thinner than this is marked, mm. */
  readonly least_mm: number;
  /** The upper end of the scale of colours, mm: all that is thicker looks the same. */
  readonly full_mm: number;
}

/** The same for every model, so that they can be compared. */
export const wallScale = (wall_mm: number): WallScale => ({ least_mm: wall_mm, full_mm: FULL * wall_mm || FULL_MM });
