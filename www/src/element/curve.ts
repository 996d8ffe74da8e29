/** The trade-off curve of a model: fetched when it is another one, and finding one's way on it. */
import { asSlicerError, isAbort } from "../api/error.js";
import type { Slicer } from "../api/index.js";
import type { TradeoffPoint } from "../api/wire.js";
import type { Result } from "./result.js";

/** Points of the curve: one a notch of the quality slider. */
const POINTS = 24;

export class Curve {
  /** The best plans of the model, from the tightest tolerance to the loosest; null until they are known. */
  points: readonly TradeoffPoint[] | null = null;
  /** A quality that is wanted as soon as the curve is known. */
  wanted: number | null = null;
  #of: string | null = null;

  forget(): void {
    this.points = null;
    this.#of = null;
  }

  /** Forgets points that are not of this result's options. */
  fit(result: Result): void {
    if (keyOf(result) !== this.#of) this.points = null;
  }

  /** Whether there was a curve to fetch. Uniform plans have none. */
  async fetch(client: Pick<Slicer, "tradeoff">, result: Result): Promise<boolean> {
    const key = keyOf(result);
    if (result.report.planner === "uniform" || key === this.#of) return false;
    this.#of = key;
    const { tolerance: _, ...options } = result.options;
    const { points } = await client.tradeoff(options, POINTS).catch((error: unknown) => {
      // A plan may hold where no curve does; only a broken worker is news.
      if (asSlicerError(error).code === "crash" || isAbort(error)) throw error;
      return { points: null };
    });
    if (this.#of === key) this.points = points;
    return true;
  }

  /** The index of the point that is wanted; it is wanted no more then. Null if there is none, or not yet. */
  takeWanted(): number | null {
    const { wanted, points } = this;
    if (wanted === null || points === null) return null;
    this.wanted = null;
    return Math.round((1 - wanted) * (points.length - 1));
  }

  /** Where a tolerance lies, from 0, the quickest, to 1, the finest; null before the curve is known. */
  placeOf(tolerance: number): number | null {
    if (this.points === null) return null;
    return this.points.length < 2 ? 1 : notchOf(this.points, tolerance) / (this.points.length - 1);
  }
}

/** What the curve depends on: all but the tolerance. */
function keyOf({ options: { tolerance: _, ...options } }: Result): string {
  return JSON.stringify(options);
}

/** The notch of the point whose tolerance is nearest to the plan's, counted from the loosest. */
export function notchOf(points: readonly Pick<TradeoffPoint, "tolerance">[], tolerance: number): number {
  let nearest = 0;
  const distance = (index: number): number => Math.abs((points[index]?.tolerance ?? 0) - tolerance);
  for (let index = 1; index < points.length; index++) if (distance(index) < distance(nearest)) nearest = index;
  return points.length - 1 - nearest;
}
