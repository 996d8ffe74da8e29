/** The plan against the two uniform plans it competes with, as rows and as one sentence. */
import * as format from "./format.js";
import type { Report } from "./wire.js";

export interface Row {
  name: string;
  layers: number;
  error_mm: number;
  /** Whether the error stays within the tolerance. */
  holds: boolean;
  /** Set for the row of the plan itself. */
  own: boolean;
}

/** Room for the rounding of a sum of bins. */
const SLACK_MM = 1e-6;

export function holds(error_mm: number, report: Report): boolean {
  return error_mm <= report.tolerance_mm + SLACK_MM;
}

/** Finest uniform plan, this plan, coarsest uniform plan. `limits` are the thinnest and the thickest layer in mm. */
export function rows(report: Report, limits: readonly [number, number]): Row[] {
  const row = (name: string, layers: number, error_mm: number, own = false): Row => ({
    name,
    layers,
    error_mm,
    holds: holds(error_mm, report),
    own,
  });
  const { uniform } = report;
  return [
    row(`Uniform ${format.fine(limits[0])}`, uniform.finest_layers, uniform.finest_error_mm),
    row("This plan", report.layers, report.max_error_mm, true),
    row(`Uniform ${format.fine(limits[1])}`, uniform.coarsest_layers, uniform.coarsest_error_mm),
  ];
}

/** What the plan gains, in a sentence. */
export function sentence(report: Report, limits: readonly [number, number]): string {
  const { uniform, layers } = report;
  const [min, max] = limits.map((mm) => format.fine(mm)) as [string, string];
  const tolerance = format.fine(report.tolerance_mm);
  const within = holds(report.max_error_mm, report);

  if (!within) {
    return `The error reaches ${format.fine(report.max_error_mm)}, more than the ${tolerance} you allow.`;
  }
  if (report.planner === "uniform") return `Uniform layers, within ${tolerance} all the way up. Adaptive ones may need fewer.`;
  if (layers <= uniform.coarsest_layers && holds(uniform.coarsest_error_mm, report)) {
    return `As few as uniform ${max}, and within ${tolerance} all the way up.`;
  }
  const finest = `uniform ${min} (${format.count(uniform.finest_layers)})`;
  if (layers >= uniform.finest_layers) return `As many as ${finest}: this tolerance leaves no room for thicker layers.`;
  const saved = format.percent(1 - layers / uniform.finest_layers);
  const same = holds(uniform.finest_error_mm, report) ? ", same tolerance" : ", and it keeps the tolerance where that does not";
  return `${saved} fewer than ${finest}${same}.`;
}
