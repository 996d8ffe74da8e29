/** Figures of a result: print time, layers, resin, savings, and a comparison with uniform layers. */
import { css, html, nothing, type LitElement, type TemplateResult } from "lit";
import { isFilament } from "../../api/facts.js";
import type { Language } from "../../texts/index.js";
import { rows, sentence } from "../state/comparison.js";
import { METRICS } from "../state/metric.js";
import type { Result, Shown } from "../state/result.js";
import { FetchedPanel } from "../parts/part.js";
import { styled } from "../parts/styled.js";

export const summaryStyles = css`
  details.quiet summary {
    width: fit-content;
    cursor: pointer;
  }
  .facts {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem 2rem;
    margin-top: 0.5rem;
  }
  .underside {
    display: block;
    width: 8rem;
    .solid {
      fill: currentColor;
      opacity: 0.35;
    }
    .excess {
      fill: var(--cusp-bad);
    }
    .arrow {
      fill: none;
      stroke: currentColor;
    }
  }
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
    font-size: clamp(2.75rem, 2rem + 3vw, 4rem);
    font-weight: 650;
    line-height: 1;
    letter-spacing: -0.02em;
    font-variant-numeric: tabular-nums;
  }
  .count small,
  .amount {
    font-size: 1.25rem;
    font-weight: 500;
    letter-spacing: 0;
  }
  .amount small {
    font-size: inherit;
  }
  .gain {
    margin-top: 0.5rem;
    max-width: 34rem;
    text-wrap: pretty;
  }
  /* A line of its own below the number and the button. */
  #file {
    flex-basis: 100%;
    padding-inline-end: max(0px, 100% - 44rem);
    text-wrap: pretty;
  }
  /* Its own width decides, not the screen's: it stands in wide cards and in narrow columns. */
  .comparison {
    container: comparison / inline-size;
    margin-top: 1.25rem;
  }
  table {
    width: 100%;
    border-collapse: collapse;
    font-size: 0.9375rem;
    font-variant-numeric: tabular-nums;
  }
  th,
  td {
    padding-block: 0.4375rem;
    padding-inline: 0 0.75rem;
    border-top: 1px solid var(--cusp-line);
    text-align: start;
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
    text-align: end;
  }
  thead th.number {
    text-align: end;
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
  @media (forced-colors: active) {
    td.bar div {
      forced-color-adjust: none;
      background: GrayText;
      opacity: 1;
    }
    tr.own td.bar div {
      background: Highlight;
    }
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
  @container comparison (max-width: 36rem) {
    .holds {
      display: block;
      font-size: 0.8125rem;
      white-space: normal;
    }
    td.bar,
    th.bar {
      display: none;
    }
    /* Four columns do not fit a phone: the plan's name goes above its numbers. */
    tr {
      display: grid;
      grid-template-columns: minmax(3rem, auto) minmax(5.75rem, auto) minmax(0, 1fr);
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
      text-align: start;
    }
    thead th:first-child {
      display: none;
    }
  }
`;

/** Figures of a result and its savings. `shown` provides the figures, from a preview while the model is being turned. */
export function figures(result: Result, shown: Pick<Shown, "layers" | "print_time_s">, language: Language): TemplateResult {
  const { report } = result;
  const { texts, format } = language;
  const layers = html`<span data-layers=${shown.layers}>${format.count(shown.layers)} <small>${texts.plan.layers({ count: shown.layers })}</small></span>`;
  return html`<div>
    <div class="figure">
      ${isFilament(report.print_file.format)
        ? html`<p class="count">${layers}</p>`
        : html`<p class="count"><span class="visually-hidden">${texts.plan.columns.time}</span> ${format.time(shown.print_time_s)}</p>
            <p class="amount">${layers}</p>
            <p class="amount">${texts.plan.resin({ ml: format.millilitres(report.resin_ml) })}</p>`}
    </div>
    <p class="gain">${sentence(result, language)}</p>
  </div>`;
}

/** Table that compares the plan with uniform layers. */
export function comparison(result: Result, { texts, format }: Language): TemplateResult {
  const { report } = result;
  const compared = rows(result);
  const most = Math.max(...compared.map(({ layers }) => layers));
  const { columns } = texts.plan;
  // Exposure times do not apply to filament printers.
  const isResin = !isFilament(report.print_file.format);
  return html`<div class="comparison">
    <table>
      <thead>
        <tr>
          <th scope="col">${columns.plan}</th>
          <th scope="col" class="number">${columns.layers}</th>
          <th class="bar" aria-hidden="true"></th>
          ${isResin ? html`<th scope="col" class="number">${columns.time}</th>` : nothing}
          <th scope="col">${texts.metrics[report.metric].head}</th>
        </tr>
      </thead>
      <tbody>
        ${compared.map(
          ({ kind, uniform_mm, layers, print_time_s, max_error, holds }) => html`<tr class=${kind}>
            <th scope="row">${kind === "own" || uniform_mm === null ? texts.plan.own : texts.plan[kind]({ thickness: format.fine(uniform_mm) })}</th>
            <td class="number">${format.count(layers)}</td>
            <td class="bar" aria-hidden="true"><div ${styled({ width: `${(100 * layers) / most}%` })}></div></td>
            ${isResin ? html`<td class="number">${format.time(print_time_s)}</td>` : nothing}
            <td>
              ${METRICS[report.metric].error(max_error, format)}
              <span class="holds ${holds ? "within" : "over"}">${holds ? texts.plan.within : texts.plan.over}</span>
            </td>
          </tr>`,
        )}
      </tbody>
    </table>
  </div>`;
}

const detailsCode = new FetchedPanel("details", () => import("./run-details.js"));
/** Elements whose details were opened. */
const opened = new WeakSet<LitElement>();

/** Details of the computation, in a section that is initially collapsed; fetched when opened. */
export function details(element: LitElement, result: Result, language: Language): TemplateResult {
  const { texts: { details: words }, format } = language;
  const { report } = result;
  const method = report.gpu_method === "fill" || report.gpu_method === "peel" ? words.methods[report.gpu_method] : null;
  const how = [report.adapter, method].filter((part) => part !== null).join(", ");
  const ran = report.backend !== "gpu" ? words.cpu : how === "" ? words.gpu.bare : words.gpu.how({ how });
  const toggled = (): void => {
    opened.add(element);
    element.requestUpdate();
  };
  return html`<details class="quiet figures" @toggle=${toggled}>
    <summary>${words.ran({ where: ran, duration: format.duration(report.timings_ms.total) })}</summary>
    ${opened.has(element) ? (detailsCode.code?.runDetails(report, language) ?? detailsCode.instead(element, language)) : nothing}
  </details>`;
}
