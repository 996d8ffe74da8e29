/** The result in one look: the number of layers, the time they take, what that saves, and the two uniform plans beside it. */
import { css, html, nothing, type TemplateResult } from "lit";
import { rows, sentence } from "./comparison.js";
import * as format from "../texts/format.js";
import { METRICS } from "./metric.js";
import type { Result } from "./session.js";

export const summaryStyles = css`
  .answer {
    display: flex;
    flex-wrap: wrap;
    align-items: end;
    justify-content: space-between;
    gap: 1rem 2rem;
  }
  .figure {
    display: flex;
    flex-wrap: wrap;
    align-items: baseline;
    gap: 0.25rem 1.5rem;
  }
  .count {
    display: flex;
    align-items: baseline;
    gap: 0.625rem;
    font-size: clamp(2.75rem, 2rem + 3vw, 4rem);
    font-weight: 650;
    line-height: 1;
    letter-spacing: -0.02em;
    font-variant-numeric: tabular-nums;
  }
  .count span,
  .time {
    font-size: 1.25rem;
    font-weight: 500;
    letter-spacing: 0;
  }
  .gain {
    margin-top: 0.5rem;
    max-width: 34rem;
    text-wrap: pretty;
  }
  table {
    width: 100%;
    margin-top: 1.25rem;
    border-collapse: collapse;
    font-size: 0.9375rem;
    font-variant-numeric: tabular-nums;
  }
  th,
  td {
    padding: 0.4375rem 0.75rem 0.4375rem 0;
    border-top: 1px solid var(--cusp-line);
    text-align: left;
    font-weight: 400;
    white-space: nowrap;
  }
  thead th {
    border: 0;
    padding-top: 0;
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  td.number {
    text-align: right;
  }
  thead th.number {
    text-align: right;
  }
  td.bar {
    width: 45%;
  }
  td.bar div {
    height: 0.625rem;
    border-radius: 3px;
    background: var(--cusp-field);
    opacity: 0.55;
  }
  tr.own th,
  tr.own td {
    font-weight: 600;
  }
  tr.own td.bar div {
    background: var(--cusp-accent);
    opacity: 1;
  }
  .over {
    color: var(--cusp-bad);
  }
  .within {
    color: var(--cusp-good);
  }
  @media (max-width: 640px) {
    .holds {
      display: block;
      font-size: 0.8125rem;
      white-space: normal;
    }
    td.bar,
    th.bar {
      display: none;
    }
    /* Four columns do not fit a phone: a plan's name stands above its figures. */
    tr {
      display: grid;
      grid-template-columns: 3rem 5.75rem minmax(0, 1fr);
      column-gap: 0.5rem;
      padding-block: 0.4375rem;
      border-top: 1px solid var(--cusp-line);
    }
    thead tr {
      padding-top: 0;
      border: 0;
    }
    tbody th {
      grid-column: 1 / -1;
    }
    th,
    td,
    td.number,
    thead th.number {
      padding: 0;
      border: 0;
      text-align: left;
    }
    thead th:first-child {
      display: none;
    }
  }
`;

/** `note` comes first, if there is one; `action` stands beside the number: the download. */
export function summary(result: Result, note: TemplateResult | typeof nothing, action: TemplateResult): TemplateResult {
  const { report } = result;
  const { error } = METRICS[report.metric];
  const compared = rows(result);
  const most = Math.max(...compared.map(({ layers }) => layers));
  return html`
    ${note}
    <div class="answer">
      <div>
        <div class="figure">
          <p class="count" data-layers=${report.layers}>${format.count(report.layers)}<span>layers</span></p>
          <p class="time">about ${format.time(report.print_time_s)} to print</p>
        </div>
        <p class="gain">${sentence(result)}</p>
      </div>
      ${action}
    </div>
    <table>
      <thead>
        <tr>
          <th scope="col">Plan</th>
          <th scope="col" class="number">Layers</th>
          <th class="bar" aria-hidden="true"></th>
          <th scope="col" class="number">Time</th>
          <th scope="col">Largest error</th>
        </tr>
      </thead>
      <tbody>
        ${compared.map(
          ({ name, layers, print_time_s, max_error, holds, own }) => html`<tr class=${own ? "own" : ""}>
            <th scope="row">${name}</th>
            <td class="number">${format.count(layers)}</td>
            <td class="bar" aria-hidden="true"><div style="width:${(100 * layers) / most}%"></div></td>
            <td class="number">${format.time(print_time_s)}</td>
            <td>
              ${error(max_error)}
              <span class="holds ${holds ? "within" : "over"}">${holds ? "within tolerance" : "over tolerance"}</span>
            </td>
          </tr>`,
        )}
      </tbody>
    </table>
  `;
}

const STAGES = [
  ["load", "Reading"],
  ["ldi", "Casting rays"],
  ["profile", "Measuring the surface"],
  ["plan", "Planning"],
  ["masks", "Masks"],
] as const;

/** How the result came about, for those who want to know. */
export function details({ report }: Result): TemplateResult {
  const { mask, metric, timings_ms } = report;
  const { error } = METRICS[metric];
  const ran = report.backend === "gpu" ? `the GPU${report.adapter === null ? "" : ` (${report.adapter})`}` : "the CPU";
  return html`<details class="quiet figures">
    <summary>Computed on ${ran} in ${format.duration(timings_ms.total)}</summary>
    <dl class="facts">
      ${STAGES.map(([key, name]) =>
        timings_ms[key] > 0
          ? html`<div><dt>${name}</dt><dd>${format.duration(timings_ms[key])}</dd></div>`
          : nothing,
      )}
      <div><dt>Largest error on the mesh</dt><dd>${error(report.max_error)}</dd></div>
      <div><dt>The same as rays see it</dt><dd>${error(report.sampled_error)}</dd></div>
      ${metric === "cusp"
        ? nothing
        : html`<div><dt>Largest cusp height</dt><dd>${format.fine(report.max_error_mm)}</dd></div>`}
      <div><dt>Planes at flats</dt><dd>${format.count(report.snapped_mm.length)}</dd></div>
      <div><dt>Planned from</dt><dd>${report.source === "exact" ? "Every facet" : "What rays see"}</dd></div>
      <div><dt>Time between exposures</dt><dd>${format.seconds(report.overhead_s)}</dd></div>
      <div><dt>Resin</dt><dd>${format.millilitres(report.resin_ml)}</dd></div>
      <div><dt>Masks</dt><dd>${format.count(mask.width)} × ${format.count(mask.height)} pixels of ${format.fine(mask.pitch_mm)}</dd></div>
      <div><dt>Profile</dt><dd>${format.count(report.bins)} intervals of ${format.fine(report.bin_mm)}</dd></div>
      <div><dt>Surface hits</dt><dd>${format.count(report.hits)}</dd></div>
    </dl>
  </details>`;
}
