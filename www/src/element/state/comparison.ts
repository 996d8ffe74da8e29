/** Comparison of the plan with uniform layers, as rows and as a sentence. */
import type { Minimize, Report, BestUniform } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { METRICS } from "./metric.js";
import type { Result } from "./result.js";

/** Input of a comparison: a result without its profile. */
export type Compared = Pick<Result, "report" | "limits" | "options">;

/** The plan itself, or uniform layers: the best within tolerance, or those at either end of the range of thicknesses. */
export type Kind = "own" | "best" | "finest" | "coarsest";

export interface Row {
  kind: Kind;
  /** Thickness of uniform layers in mm; null for the plan itself. */
  uniform_mm: number | null;
  layers: number;
  print_time_s: number;
  /** In the metric's unit. */
  max_error: number;
  /** True if the error stays within the tolerance. */
  holds: boolean;
}

/** Allowance for rounding in a sum of bins, as a fraction of the tolerance. */
const SLACK = 1e-6;

const holds = (report: Report, max_error: number): boolean => max_error <= report.tolerance * (1 + SLACK);

const minimized = ({ options }: Pick<Compared, "options">): Minimize => options.minimize ?? "layers";

/** The best uniform layers within tolerance, or null. */
const bestBy = ({ report }: Pick<Compared, "report">, by: Minimize): BestUniform | null =>
  (by === "time" ? report.uniform.quickest : report.uniform.fewest) ?? null;

/** Rows from thin to thick uniform layers, with the plan among them. The best within tolerance replace an end that they equal. */
export function rows(compared: Compared): Row[] {
  const { report, limits } = compared;
  const row = (kind: Kind, uniform_mm: number | null, figures: Pick<Report, "layers" | "print_time_s" | "max_error">): Row => {
    const { layers, print_time_s, max_error } = figures;
    return { kind, uniform_mm, layers, print_time_s, max_error, holds: holds(report, max_error) };
  };
  const { finest, coarsest } = report.uniform;
  const best = report.planner === "uniform" ? null : bestBy(compared, minimized(compared));
  const isBest = ({ layers, print_time_s }: Pick<Report, "layers" | "print_time_s">): boolean =>
    best !== null && layers === best.layers && print_time_s === best.print_time_s;
  return [
    ...(isBest(finest) ? [] : [row("finest", limits[0], finest)]),
    ...(best === null ? [] : [row("best", best.layer_mm, best)]),
    row("own", null, report),
    ...(isBest(coarsest) ? [] : [row("coarsest", limits[1], coarsest)]),
  ];
}

/** Uniform layers that do about as well as the plan, or null. */
export const enough = (compared: Compared): BestUniform | null =>
  compared.report.uniform.is_enough ? bestBy(compared, minimized(compared)) : null;

/** Sentence on the plan's gain over the best uniform layers within the same tolerance. */
export function sentence(compared: Compared, { texts: { gain, metrics }, format }: Language, by = minimized(compared)): string {
  const { report, limits } = compared;
  const error = (value: number): string => METRICS[report.metric].error(value, format);
  if (!holds(report, report.max_error)) return gain.over({ subject: metrics[report.metric].subject, error: error(report.max_error), tolerance: error(report.tolerance) });
  if (report.planner === "uniform") return gain.isUniform({ tolerance: error(report.tolerance) });
  const best = bestBy(compared, by);
  if (best === null) return gain.none({ thin: format.fine(limits[0]), thick: format.fine(limits[1]), tolerance: error(report.tolerance) });
  const of = ({ layers, print_time_s }: Pick<Report, "layers" | "print_time_s">): number => (by === "time" ? print_time_s : layers);
  const saved = 1 - of(report) / of(best);
  const figure = by === "time" ? format.time(best.print_time_s) : format.count(best.layers);
  const isLittle = saved < 0.005 || (by === minimized(compared) && report.uniform.is_enough);
  if (isLittle) return gain.little({ uniform: format.fine(best.layer_mm), figure, tolerance: error(report.tolerance) });
  return gain.saved[by]({ part: format.percent(saved), uniform: format.fine(best.layer_mm), figure });
}
