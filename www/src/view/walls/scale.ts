/** Colour scale for wall thickness. */

/** The end of the scale as a multiple of the limit: thick walls need not be told apart. */
const FULL = 10;

/** The end of the scale without a limit, mm. */
const FULL_MM = 4;

export interface WallScale {
  /** Thinner walls are marked, mm. */
  readonly least_mm: number;
  /** Upper end of the colour scale, mm; thicker walls look the same. */
  readonly full_mm: number;
}

/** The same for every model, so that they can be compared. */
export const wallScale = (wall_mm: number): WallScale => ({ least_mm: wall_mm, full_mm: FULL * wall_mm || FULL_MM });
