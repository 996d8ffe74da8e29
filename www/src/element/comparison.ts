/** The plan against the two uniform plans it competes with, as rows and as one sentence. */
import * as format from "../texts/format.js";
import { METRICS } from "./metric.js";
import type { Result } from "./session.js";
import type { Report } from "../api/wire.js";

/** What is compared: a result without its profile. */
export type Compared = Pick<Result, "report" | "limits" | "options">;

export interface Row {
  name: string;
  layers: number;
  print_time_s: number;
  /** In the metric's unit. */
  max_error: number;
  /** Whether the error stays within the tolerance. */
  holds: boolean;
  /** Set for the row of the plan itself. */
  own: boolean;
}

type Figures = Pick<Row, "layers" | "print_time_s" | "max_error">;

/** Room for the rounding of a sum of bins, as a part of the tolerance. */
const SLACK = 1e-6;

const holds = ({ max_error }: Figures, { tolerance }: Report): boolean => max_error <= tolerance * (1 + SLACK);

/** Finest uniform plan, this plan, coarsest uniform plan. */
export function rows({ report, limits }: Compared): [Row, Row, Row] {
  const row = (name: string, figures: Figures, own = false): Row => {
    const { layers, print_time_s, max_error } = figures;
    return { name, layers, print_time_s, max_error, holds: holds(figures, report), own };
  };
  const { finest, coarsest } = report.uniform;
  return [
    row(`Uniform ${format.fine(limits[0])}`, finest),
    row("This plan", report, true),
    row(`Uniform ${format.fine(limits[1])}`, coarsest),
  ];
}

/** Words for what a plan has least of. */
interface Gain {
  of(row: Row): number;
  words(row: Row): string;
  least: string;
  most: string;
  saved: string;
}

const GAINS: Record<"layers" | "time", Gain> = {
  layers: {
    of: ({ layers }) => layers,
    words: ({ layers }) => format.count(layers),
    least: "As few as",
    most: "As many as",
    saved: "fewer than",
  },
  time: {
    of: ({ print_time_s }) => print_time_s,
    words: ({ print_time_s }) => format.time(print_time_s),
    least: "As quick as",
    most: "As slow as",
    saved: "less time than",
  },
};

/** What the plan gains, in a sentence. */
export function sentence(compared: Compared): string {
  const { report, options } = compared;
  const [finest, own, coarsest] = rows(compared);
  const { error } = METRICS[report.metric];
  const tolerance = error(report.tolerance);
  const lower = ({ name }: Row): string => name.replace("Uniform", "uniform");

  if (!own.holds) return `The error reaches ${error(own.max_error)}, more than the ${tolerance} allowed.`;
  if (report.planner === "uniform") return `Uniform layers, within ${tolerance} all the way up. Adaptive ones may need fewer.`;
  const gain = GAINS[options.minimize ?? "layers"];
  if (gain.of(own) <= gain.of(coarsest) && coarsest.holds) {
    return `${gain.least} ${lower(coarsest)}, and within ${tolerance} all the way up.`;
  }
  const beside = `${lower(finest)} (${gain.words(finest)})`;
  if (gain.of(own) >= gain.of(finest)) return `${gain.most} ${beside}: this tolerance leaves no room for thicker layers.`;
  const saved = format.percent(1 - gain.of(own) / gain.of(finest));
  if (coarsest.holds) return `${saved} ${gain.saved} ${beside}, but ${lower(coarsest)} keeps the tolerance as well.`;
  const same = finest.holds ? ", same tolerance" : ", and it keeps the tolerance where that does not";
  return `${saved} ${gain.saved} ${beside}${same}.`;
}
