/** The trade-off curve as a picture with a slider; each notch is a best plan, fastest first. */
import { css, html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { usualOf } from "../../api/facts.js";
import type { TradeoffPoint } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { sentence } from "../state/comparison.js";
import { notchOf, placeAmong, type Planned } from "../state/curve.js";
import { METRICS } from "../state/metric.js";
import type { Result } from "../state/result.js";
import { shared } from "../styles/shared.js";
import { elementWith, given } from "../../view/properties.js";

/** Internal units of the picture, which is stretched to fit its box. */
const WIDTH = 400;
const HEIGHT = 120;
const MARGIN = 12;

export interface Mark {
  x: number;
  y: number;
}

export interface Picture {
  /** Points of the curve, the loosest first: dot i belongs to notch i. */
  dots: Mark[];
  own: Mark;
  finest: Mark;
  coarsest: Mark;
}

/**
 * Positions in the picture: each point above its notch, finer plans to the right, longer print times at the top. A plan that is not a point
 * lies between the two points whose errors enclose its own.
 */
export function pictureOf(points: readonly Planned[], { report }: Pick<Result, "report">): Picture {
  const { finest, coarsest } = report.uniform;
  const [shortest, longest] = timesOf(points, report);
  const mark = (plan: Planned): Mark => ({
    x: MARGIN + (placeAmong(points, plan) / (points.length - 1)) * (WIDTH - 2 * MARGIN),
    y: HEIGHT - MARGIN - (longest === shortest ? 0.5 : (plan.print_time_s - shortest) / (longest - shortest)) * (HEIGHT - 2 * MARGIN),
  });
  const dots = points.map(mark).reverse();
  return { dots, own: mark(report), finest: mark(finest), coarsest: mark(coarsest) };
}

/** A quality with a name, and the index of its point. */
export interface Grade {
  readonly name: "draft" | "standard" | "fine";
  readonly index: number;
}

/** The loosest point, the one nearest to the usual tolerance, and the tightest; the middle one only if it is another. */
export function gradesOf(points: readonly Pick<TradeoffPoint, "tolerance">[], usual: number): readonly Grade[] {
  const off = (index: number): number => Math.abs((points[index]?.tolerance ?? Infinity) - usual);
  const last = points.length - 1;
  const middle = points.reduce((best, _, index) => (off(index) < off(best) ? index : best), 0);
  const standard: Grade[] = middle > 0 && middle < last ? [{ name: "standard", index: middle }] : [];
  return [{ name: "draft", index: last }, ...standard, { name: "fine", index: 0 }];
}

/** Shortest and longest print time: the lower and the upper edge of the picture. */
function timesOf(points: readonly Planned[], report: Result["report"]): [number, number] {
  const times = [...points, report, report.uniform.finest, report.uniform.coarsest].map(({ print_time_s }) => print_time_s);
  return [Math.min(...times), Math.max(...times)];
}

const PROPERTIES = {
  /** From the tightest tolerance to the loosest; null while they are being computed. */
  points: given<readonly TradeoffPoint[] | null>(null),
  result: given<Result | null>(null),
  /** True if only the page may change the tolerance. */
  isFixed: given(false),
  language: given(languageOf()),
};

export class CuspQuality extends elementWith(PROPERTIES) {
  static override styles = [
    shared,
    css`
      :host {
        display: flex;
        flex-direction: column;
        height: 100%;
        min-width: 0;
        container-type: inline-size;
      }
      svg {
        display: block;
        flex: 1 1 7rem;
        width: 100%;
        height: 7rem;
        max-height: 14rem;
        overflow: visible;
        direction: ltr;
      }
      /* Dots are strokes without a length: the picture is stretched, and they are not. */
      path {
        fill: none;
        stroke: var(--cusp-accent);
        stroke-linecap: round;
        stroke-linejoin: round;
        vector-effect: non-scaling-stroke;
      }
      .curve {
        stroke-width: 2px;
      }
      .dot {
        stroke-width: 6px;
      }
      .own {
        stroke-width: 18px;
      }
      .own.inside {
        stroke: var(--cusp-card);
        stroke-width: 10px;
      }
      .uniform {
        stroke: var(--cusp-quiet);
        stroke-linecap: square;
        stroke-width: 11px;
      }
      .uniform.inside {
        stroke: var(--cusp-card);
        stroke-width: 6px;
      }
      .base {
        stroke: var(--cusp-line);
        stroke-width: 1px;
      }
      input {
        direction: ltr;
        /* So that its thumb, about a rem wide, stands below the dot of its notch: see MARGIN. */
        width: calc(94% + 1rem);
        height: 2.25rem;
        margin: 0 calc(3% - 0.5rem);
        accent-color: var(--cusp-accent);
      }
      .grades {
        direction: ltr;
        display: flex;
        gap: 0.25rem;
        justify-content: space-between;
      }
      .grades button {
        display: grid;
        gap: 0;
        padding: 0.25rem;
        border: 0;
        font-size: 0.8125rem;
      }
      .grades small {
        color: var(--cusp-quiet);
        font-weight: 400;
      }
      .grades [aria-pressed="true"] {
        color: var(--cusp-accent);
      }
      .gain {
        margin-top: 0.5rem;
        font-weight: 550;
        text-wrap: pretty;
      }
      @container (max-width: 24rem) {
        /* Room for the longest sentences, so that nothing moves when another plan says more. */
        .head span {
          min-block-size: 2lh;
        }
        .gain {
          min-block-size: 4lh;
          font-size: 0.9375rem;
          line-height: 1.4;
        }
      }
      .axis {
        direction: ltr;
        font-size: 0.8125rem;
      }
      .key {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(100%, 15rem), 1fr));
        gap: 0.125rem 1.25rem;
        margin: 0.5rem 0 0;
        padding: 0;
        list-style: none;
        font-size: 0.8125rem;
      }
      .key li {
        display: grid;
        grid-template-columns: 1rem minmax(0, 1fr);
        gap: 0.375rem;
        align-items: baseline;
      }
      .key i {
        box-sizing: border-box;
        justify-self: center;
        width: 0.6875rem;
        height: 0.6875rem;
        border: 0.3125rem solid var(--cusp-quiet);
      }
      .key .point {
        width: 0.375rem;
        height: 0.375rem;
        border: 0.1875rem solid var(--cusp-accent);
        border-radius: 50%;
        translate: 0 -0.125rem;
      }
      .key .this {
        width: 1rem;
        height: 1rem;
        border: 0.25rem solid var(--cusp-accent);
        border-radius: 50%;
        translate: 0 0.1875rem;
      }
      .key .coarse {
        border-width: 2px;
      }
      .waiting {
        min-height: 7.5rem;
        display: grid;
        place-items: center;
      }
      @media (forced-colors: active) {
        path,
        .base,
        .uniform {
          stroke: CanvasText;
        }
        .own {
          stroke: Highlight;
        }
        .own.inside,
        .uniform.inside {
          stroke: Canvas;
        }
        .key i {
          border-color: CanvasText;
        }
        .key .this {
          border-color: Highlight;
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { points, result, language } = this;
    const { texts, format } = language;
    const words = texts.quality;
    if (result === null || points === null || points.length === 0) {
      return html`<div class="head"><h3>${words.title}</h3></div>
        <p class="waiting quiet">${points === null ? words.waiting : nothing}</p>`;
    }
    const { report, limits } = result;
    const said = words.said({ head: texts.metrics[report.metric].head, error: METRICS[report.metric].error(report.max_error, format), time: format.time(report.print_time_s), layers: report.layers });
    const head = html`<div class="head">
      <h3>${words.title}</h3>
      <span class="quiet figures">${said}</span>
    </div>`;
    const gain = html`<p class="gain">${sentence(result, language, "time")}</p>`;
    if (points.length === 1) return html`${head} ${gain} <p class="single quiet">${words.single}</p>`;
    const { dots, own, finest, coarsest } = pictureOf(points, result);
    return html`
      ${head}
      <p class="axis quiet figures"><span aria-hidden="true">↑</span> ${words.time({ longest: format.time(timesOf(points, report)[1]) })}</p>
      <svg
        viewBox="0 0 ${WIDTH} ${HEIGHT}"
        preserveAspectRatio="none"
        role="img"
        aria-label=${words.axis({ head: texts.metrics[report.metric].head })}
      >
        <path class="base" d="M0 ${HEIGHT}h${WIDTH}" />
        <path class="curve" d=${`M${dots.map(({ x, y }) => `${x} ${y}`).join("L")}`} />
        <path class="dot" d=${dots.map(dot).join("")} />
        <path class="uniform" d=${dot(finest) + dot(coarsest)} />
        <path class="uniform inside" d=${dot(coarsest)} />
        <path class="own" d=${dot(own)} />
        <path class="own inside" d=${dot(own)} />
      </svg>
      <input
        type="range"
        aria-label=${words.title}
        aria-valuetext=${said}
        min="0"
        max=${points.length - 1}
        step="1"
        ?disabled=${this.isFixed}
        .value=${live(String(notchOf(points, report)))}
        @input=${this.#moved}
      />
      <div class="grades">
        ${gradesOf(points, usualOf(report.metric, report.print_file.format)).map(
          ({ name, index }) => html`<button
            class="small"
            aria-pressed=${points.length - 1 - index === notchOf(points, report) ? "true" : "false"}
            ?disabled=${this.isFixed}
            @click=${() => this.#choose(index)}
          >
            ${words.grades[name]} <small>${METRICS[report.metric].error(points[index]?.max_error ?? 0, format)}</small>
          </button>`,
        )}
      </div>
      <ul class="key quiet figures">
        <li><i class="this"></i>${texts.plan.own}</li>
        <li><i class="point"></i>${words.points}</li>
        <li><i class="coarse"></i>${words.coarsest({ uniform: format.fine(limits[1]), time: format.time(report.uniform.coarsest.print_time_s) })}</li>
        <li><i></i>${words.finest({ uniform: format.fine(limits[0]), time: format.time(report.uniform.finest.print_time_s) })}</li>
      </ul>
      ${gain}
    `;
  }

  readonly #moved = (event: Event): void => {
    const notch = Number((event.target as HTMLInputElement).value);
    this.#choose((this.points?.length ?? 1) - 1 - notch);
  };

  #choose(index: number): void {
    this.dispatchEvent(new CustomEvent<number>("cusp-point", { detail: index }));
  }
}

const dot = ({ x, y }: Mark): string => `M${x} ${y}h0`;
