/** The result in one look: the number of layers, what it saves, and the two uniform plans beside it. */
import { css, html, nothing, type TemplateResult } from "lit";
import { rows, sentence } from "./comparison.js";
import * as format from "./format.js";
import type { Result } from "./session.js";

export const summaryStyles = css`
  .answer {
    display: flex;
    flex-wrap: wrap;
    align-items: end;
    justify-content: space-between;
    gap: 1rem 2rem;
  }
  .count {
    font-size: clamp(2.75rem, 2rem + 3vw, 4rem);
    font-weight: 650;
    line-height: 1;
    letter-spacing: -0.02em;
    font-variant-numeric: tabular-nums;
  }
  .count {
    display: flex;
    align-items: baseline;
    gap: 0.625rem;
  }
  .count span {
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
    th {
      white-space: normal;
    }
    .holds {
      display: block;
      font-size: 0.8125rem;
    }
    td.bar,
    th.bar {
      display: none;
    }
    th:last-child,
    td:last-child {
      padding-right: 0;
    }
  }
`;

/** `note` comes first, if there is one; `action` stands beside the number: the download. */
export function summary(result: Result, note: TemplateResult | typeof nothing, action: TemplateResult): TemplateResult {
  const { report, limits } = result;
  const compared = rows(report, limits);
  const most = Math.max(...compared.map(({ layers }) => layers));
  return html`
    ${note}
    <div class="answer">
      <div>
        <p class="count" data-layers=${report.layers}>${format.count(report.layers)}<span>layers</span></p>
        <p class="gain">${sentence(report, limits)}</p>
      </div>
      ${action}
    </div>
    <table>
      <thead>
        <tr>
          <th scope="col">Plan</th>
          <th scope="col" class="number">Layers</th>
          <th class="bar" aria-hidden="true"></th>
          <th scope="col">Largest error</th>
        </tr>
      </thead>
      <tbody>
        ${compared.map(
          ({ name, layers, error_mm, holds, own }) => html`<tr class=${own ? "own" : ""}>
            <th scope="row">${name}</th>
            <td class="number">${format.count(layers)}</td>
            <td class="bar" aria-hidden="true"><div style="width:${(100 * layers) / most}%"></div></td>
            <td>
              ${format.fine(error_mm)}
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
  const { mask, timings_ms } = report;
  const ran = report.backend === "gpu" ? `the GPU${report.adapter === null ? "" : ` (${report.adapter})`}` : "the CPU";
  return html`<details class="quiet figures">
    <summary>Computed on ${ran} in ${format.duration(timings_ms.total)}</summary>
    <dl class="facts">
      ${STAGES.map(([key, name]) =>
        timings_ms[key] > 0
          ? html`<div><dt>${name}</dt><dd>${format.duration(timings_ms[key])}</dd></div>`
          : nothing,
      )}
      <div><dt>Masks</dt><dd>${format.count(mask.width)} × ${format.count(mask.height)} pixels of ${format.fine(mask.pitch_mm)}</dd></div>
      <div><dt>Profile</dt><dd>${format.count(report.bins)} intervals of ${format.fine(report.bin_mm)}</dd></div>
      <div><dt>Surface hits</dt><dd>${format.count(report.hits)}</dd></div>
    </dl>
  </details>`;
}
