/** Metrics of orientations as text, and differences between two orientations. */
import type { Candidate, Metric, Terms } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { orientationTexts } from "../../texts/orientation.js";
import { METRICS } from "./metric.js";

export type Metrics = NonNullable<Candidate["metrics"]>;

/** Metrics by which orientations are compared. */
export type Term = Exclude<keyof Terms, "height">;

/** Maximum number of differences. */
const MOST = 4;

const MICROMETRES = 1000;

const VALUES: Readonly<Record<Term, (metrics: Metrics) => number>> = {
  layers: ({ layers }) => layers,
  time: ({ print_time_s }) => print_time_s,
  error: ({ max_error }) => max_error,
  roughness: ({ roughness_mm }) => roughness_mm,
  overhang: ({ overhang_mm2 }) => overhang_mm2,
  islands: ({ islands }) => islands,
  cups: ({ cups_mm2 }) => cups_mm2,
  supports: ({ support_ml }) => support_ml,
  contacts: ({ contact_mm2 }) => contact_mm2,
};

/** Formatter for values of a term, with unit. */
function writer(term: Term, metric: Metric, { format }: Language): (value: number) => string {
  switch (term) {
    case "layers":
    case "islands":
      return format.count;
    case "time":
      return format.time;
    case "error":
      return (value) => METRICS[metric].error(value, format);
    case "roughness":
      return (mm) => `${format.tick(Math.round(mm * MICROMETRES * 10) / 10)}\u00a0µm`;
    case "supports":
      return format.millilitres;
    case "overhang":
    case "cups":
    case "contacts":
      return (mm2) => `${format.count(mm2)}\u00a0mm²`;
  }
}

/** A metric with its unit; errors are in that of `metric`. */
export function figure(term: Term, metrics: Metrics, metric: Metric, language: Language): string {
  return writer(term, metric, language)(VALUES[term](metrics));
}

/** Differences of `its` from `now`, those with the largest weight first. Values that read the same are omitted. */
export function differences(its: Metrics, now: Metrics, ranking: Required<Terms>, metric: Metric, language: Language): string[] {
  const { metrics: names } = language.texts;
  const { differs } = orientationTexts(language);
  const difference = (term: Term): { amount: number; written: string; isLess: boolean } | null => {
    const [value, before] = [VALUES[term](its), VALUES[term](now)];
    const write = writer(term, metric, language);
    const amount = Math.abs(value - before);
    const written = write(amount);
    return write(value) === write(before) || written === write(0) ? null : { amount, written, isLess: value < before };
  };
  const words = (term: Term): string | null => {
    const found = difference(term);
    if (found === null) return null;
    const { amount, written, isLess } = found;
    const way = isLess ? "less" : "more";
    if (term === "layers" || term === "islands") return differs[term][way]({ count: amount });
    if (term === "error") return differs.error[way]({ head: names[metric].head, amount: written });
    return differs[term][way]({ amount: written });
  };
  const terms = (Object.keys(VALUES) as Term[]).filter((term) => ranking[term] > 0).toSorted((a, b) => ranking[b] - ranking[a]);
  return terms.flatMap((term) => words(term) ?? []).slice(0, MOST);
}
