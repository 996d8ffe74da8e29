/** The trade-off curve of a model: fetched when it is another one, and finding one's way on it. */
import { asSlicerError, isAbort } from "../../api/error.js";
import type { Slicer } from "../../api/index.js";
import type { TradeoffPoint } from "../../api/wire.js";
import { METRICS } from "./metric.js";
import type { Result } from "./result.js";
import * as round from "./round.js";
import { withTolerance, type Settings } from "./settings.js";

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
  async fetch(slicer: Pick<Slicer, "tradeoff">, result: Result): Promise<boolean> {
    const key = keyOf(result);
    if (result.report.planner === "uniform" || key === this.#of) return false;
    this.#of = key;
    const { tolerance: _, ...options } = result.options;
    const { points } = await slicer.tradeoff(options, POINTS).catch((error: unknown) => {
      // A plan may hold where no curve does; only a broken worker is news.
      if (asSlicerError(error).code === "crash" || isAbort(error)) throw error;
      return { points: null };
    });
    if (this.#of === key) this.points = points === null ? null : merged(points);
    return true;
  }

  /** The index of the point that is wanted; it is wanted no more then. Null if there is none, or not yet. */
  takeWanted(): number | null {
    const { wanted, points } = this;
    if (wanted === null || points === null) return null;
    this.wanted = null;
    return Math.round((1 - wanted) * (points.length - 1));
  }

  /** Where a plan lies, from 0, the quickest, to 1, the finest; null before the curve is known. */
  placeOf(plan: Planned): number | null {
    if (this.points === null) return null;
    return this.points.length < 2 ? 1 : notchOf(this.points, plan) / (this.points.length - 1);
  }
}

/** What the curve depends on: all but the tolerance. */
function keyOf({ options }: Result): string {
  const { tolerance: _, ...others } = options;
  return JSON.stringify(others);
}

/** What a plan comes to, whatever the tolerance that it was made for. */
export type Planned = Pick<TradeoffPoint, "layers" | "max_error" | "print_time_s">;

function isSame(a: Planned, b: Planned): boolean {
  return a.layers === b.layers && a.max_error === b.max_error && a.print_time_s === b.print_time_s;
}

/** The points without those whose plan is the one before: of tolerances that give the same plan the tightest stays. */
export function merged<Point extends Planned>(points: readonly Point[]): Point[] {
  return points.filter((point, index) => {
    const before = points[index - 1];
    return before === undefined || !isSame(point, before);
  });
}

/** Where a plan lies among the points, counted in notches from the loosest: at its own, or between two by its error. */
export function placeAmong(points: readonly Planned[], plan: Planned): number {
  const loosest = [...points].reverse();
  const own = loosest.findIndex((point) => isSame(point, plan));
  if (own >= 0) return own;
  const finer = loosest.findIndex(({ max_error }) => max_error <= plan.max_error);
  if (finer === 0) return 0;
  if (finer < 0) return loosest.length - 1;
  const [above, below] = [loosest[finer - 1]?.max_error ?? 0, loosest[finer]?.max_error ?? 0];
  return finer - (plan.max_error - below) / (above - below);
}

/** The notch that is nearest to a plan. */
export function notchOf(points: readonly Planned[], plan: Planned): number {
  return Math.round(placeAmong(points, plan));
}

/** The change of settings that gives the plan of a point. */
export function withPoint(settings: Settings, point: TradeoffPoint): Pick<Settings, "tolerances"> {
  const { scale, tolerances } = METRICS[settings.metric];
  // Where a plan has no error at all, its tolerance is less than any that can be asked for.
  const tolerance = Math.max(round.up(point.tolerance * scale), tolerances[0]);
  return withTolerance(settings, String(tolerance));
}
