/** The trade-off curve of a model: fetched when its options change. Locates plans on it. */
import { asSlicerError, isAbort } from "../../api/error.js";
import type { Slicer } from "../../api/index.js";
import type { TradeoffPoint } from "../../api/wire.js";
import { METRICS } from "./metric.js";
import type { Result } from "./result.js";
import * as round from "./round.js";
import { withTolerance, type Settings } from "./settings.js";

/** Number of points to request; after merging, each is a notch of the quality slider. */
const POINTS = 24;

export class Curve {
  /** Best plans of the model, from the tightest tolerance to the loosest; null until known. */
  points: readonly TradeoffPoint[] | null = null;
  /** Quality from 0 to 1 to apply once the curve is known; null if none. */
  wanted: number | null = null;
  #of: string | null = null;

  forget(): void {
    this.points = null;
    this.#of = null;
  }

  /** Forgets the points if they belong to other options than this result. */
  fit(result: Result): void {
    if (keyOf(result) !== this.#of) this.forget();
  }

  /** Fetches the curve for a result. Returns false if it is known or the plan is uniform. Rejects on a crash or an abort. */
  async fetch(slicer: Pick<Slicer, "tradeoff">, result: Result): Promise<boolean> {
    const key = keyOf(result);
    if (result.report.planner === "uniform" || key === this.#of) return false;
    this.#of = key;
    const { tolerance: _, ...options } = result.options;
    const { points } = await slicer.tradeoff(options, POINTS).catch((error: unknown) => {
      // A plan may exist without a curve, so only crashes and aborts are reported.
      if (asSlicerError(error).code === "crash" || isAbort(error)) {
        if (this.#of === key) this.forget();
        throw error;
      }
      return { points: null };
    });
    if (this.#of === key) this.points = points === null ? null : merged(points);
    return true;
  }

  /** Index of the requested point, and clears the request; null if there is no request or the curve is unknown. */
  takeWanted(): number | null {
    const { wanted, points } = this;
    if (wanted === null || points === null) return null;
    this.wanted = null;
    return Math.round((1 - wanted) * (points.length - 1));
  }

  /** Position of a plan on the curve, from 0, the fastest, to 1, the finest; null until the curve is known. */
  placeOf(plan: Planned): number | null {
    if (this.points === null) return null;
    return this.points.length < 2 ? 1 : notchOf(this.points, plan) / (this.points.length - 1);
  }
}

/** Key of the curve: all options except the tolerance. */
function keyOf({ options }: Result): string {
  const { tolerance: _, ...others } = options;
  return JSON.stringify(others);
}

/** Figures of a plan, without the tolerance requested. */
export type Planned = Pick<TradeoffPoint, "layers" | "max_error" | "print_time_s">;

function isSame(a: Planned, b: Planned): boolean {
  return a.layers === b.layers && a.max_error === b.max_error && a.print_time_s === b.print_time_s;
}

/** Merges points with the same plan, keeping the tightest of their tolerances. */
export function merged<Point extends Planned>(points: readonly Point[]): Point[] {
  return points.filter((point, index) => {
    const before = points[index - 1];
    return before === undefined || !isSame(point, before);
  });
}

/** Position of a plan among the points, in notches from the loosest: at its own point, or between two by its error. */
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

/** Notch nearest to a plan. */
export function notchOf(points: readonly Planned[], plan: Planned): number {
  return Math.round(placeAmong(points, plan));
}

/** Change of settings that yields the plan of a point. */
export function withPoint(settings: Settings, point: TradeoffPoint): Pick<Settings, "tolerances"> {
  const { scale, tolerances } = METRICS[settings.metric];
  // The tolerance of a plan without any error is below the smallest valid one.
  const tolerance = Math.max(round.up(point.tolerance * scale), tolerances[0]);
  return withTolerance(settings, String(tolerance));
}
