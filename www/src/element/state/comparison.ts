/** Compares the plan with two uniform plans, as rows and as one sentence. */
import type { Report } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { METRICS } from "./metric.js";
import type { Result } from "./result.js";

/** What is compared: a result without its profile. */
export type Compared = Pick<Result, "report" | "limits" | "options">;

export interface Row {
  /** Thickness of a uniform plan in mm; null for the plan itself. */
  uniform_mm: number | null;
  layers: number;
  print_time_s: number;
  /** In the metric's unit. */
  max_error: number;
  /** Whether the error stays within the tolerance. */
  holds: boolean;
}

/** Allowance for rounding in a sum of bins, as a fraction of the tolerance. */
const SLACK = 1e-6;

/** Finest uniform plan, this plan, coarsest uniform plan. */
export function rows({ report, limits }: Compared): [Row, Row, Row] {
  const row = (uniform_mm: number | null, figures: Pick<Report, "layers" | "print_time_s" | "max_error">): Row => {
    const { layers, print_time_s, max_error } = figures;
    return { uniform_mm, layers, print_time_s, max_error, holds: max_error <= report.tolerance * (1 + SLACK) };
  };
  const { finest, coarsest } = report.uniform;
  return [row(limits[0], finest), row(null, report), row(limits[1], coarsest)];
}

/** What the plan gains, in a sentence. */
export function sentence(compared: Compared, { texts: { gain, metrics }, format }: Language): string {
  const { report, options, limits } = compared;
  const [finest, own, coarsest] = rows(compared);
  const error = (value: number): string => METRICS[report.metric].error(value, format);
  const tolerance = error(report.tolerance);

  if (!own.holds) return gain.over(metrics[report.metric].subject, error(own.max_error), tolerance);
  if (report.planner === "uniform") return gain.isUniform(tolerance);
  const by = options.minimize ?? "layers";
  const of = ({ layers, print_time_s }: Row): number => (by === "time" ? print_time_s : layers);
  const [thin, thick] = limits.map((mm) => format.fine(mm)) as [string, string];
  if (of(own) <= of(coarsest) && coarsest.holds) return gain.coarsest[by](thick, tolerance);
  const figure = by === "time" ? format.time(finest.print_time_s) : format.count(finest.layers);
  if (of(own) >= of(finest)) return gain.nothing[by](thin, figure);
  const saved = gain.saved[by](format.percent(1 - of(own) / of(finest)), thin, figure);
  if (coarsest.holds) return gain.coarsestToo(saved, thick);
  return finest.holds ? gain.sameTolerance(saved) : gain.onlyThis(saved);
}
