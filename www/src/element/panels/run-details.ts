/** Figures of the computation: times of its stages, errors, and sizes; fetched when a user opens them. */
import { html, nothing, type TemplateResult } from "lit";
import type { PrintThroughReport } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { METRICS } from "../state/metric.js";
import type { Result } from "../state/result.js";
import { undersidePicture } from "../parts/underside-picture.js";

const STAGES = ["load", "ldi", "profile", "plan", "masks"] as const;

export function runDetails(report: Result["report"], { texts: { details: words }, format }: Language): TemplateResult {
  const { mask, metric, timings_ms } = report;
  const error = (value: number): string => METRICS[metric].error(value, format);
  const fact = (name: string, value: string | TemplateResult): TemplateResult => html`<div><dt>${name}</dt><dd>${value}</dd></div>`;
  const undersides = (found: PrintThroughReport): TemplateResult => {
    const { before, after } = found;
    const [mean, largest, off] = [after.mean_mm, after.largest_mm, before.mean_mm].map((mm) => format.error("deviation", mm)) as [string, string, string];
    const text = words.undersidesOff({ mean, largest, before: off });
    return html`${undersidePicture(found, text)} ${text}`;
  };
  return html`<dl class="facts">
    ${STAGES.map((stage) => (timings_ms[stage] > 0 ? fact(words[stage], format.duration(timings_ms[stage])) : nothing))}
    ${fact(words.meshError, error(report.max_error))}
    ${report.sampled_error === null ? nothing : fact(words.rayError, error(report.sampled_error))}
    ${report.true_error === report.max_error ? nothing : fact(words.trueError, error(report.true_error))}
    ${metric === "cusp" ? nothing : fact(words.cuspError, format.fine(report.max_error_mm))}
    ${metric === "deviation" ? nothing : fact(words.deviation, format.error("deviation", report.max_deviation_mm))}
    ${report.print_through ? fact(words.undersides, undersides(report.print_through)) : nothing}
    ${fact(words.flats, format.count(report.snapped_mm.length))}
    ${fact(words.source, report.source === "exact" ? words.exact : words.sampled)}
    ${fact(words.overhead, format.seconds(report.overhead_s))}
    ${fact(words.mask, words.maskSize({ width: format.count(mask.width), height: format.count(mask.height), pitch: format.fine(mask.pitch_mm) }))}
    ${fact(words.bins, words.binSize({ count: format.count(report.bins), bin: format.fine(report.bin_mm) }))}
    ${fact(words.hits, format.count(report.models.reduce((sum, { hits }) => sum + hits, 0)))}
  </dl>`;
}
