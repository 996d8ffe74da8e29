/** The colour scales of layer thicknesses, of weights and of distances. */
import { css, html, nothing, type TemplateResult } from "lit";
import { gradient, placeOf } from "./palette.js";
import type { ViewTexts } from "../texts.js";

/** Maximum number of ticks between the ends; more labels would overlap. */
const TICKS = 3;

/** Round steps, times a power of ten. */
const STEPS = [1, 2, 2.5, 5, 10];

/** Minimum distance of a tick from the ends of the scale, as a fraction of it, to keep labels apart. */
const CLEAR = 0.2;

/** A few round thicknesses between the limits, away from the ends, mm. */
export function ticks([least, greatest]: readonly [number, number]): number[] {
  const [from, to] = [1000 * least, 1000 * greatest];
  const span = to - from;
  if (!(span > 0)) return [];
  const rough = span / (TICKS + 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = (STEPS.find((part) => part * power >= rough) ?? 10) * power;
  const out: number[] = [];
  for (let tick = Math.ceil(from / step) * step; tick < to; tick += step) {
    if (tick - from > CLEAR * span && to - tick > CLEAR * span) out.push(tick / 1000);
  }
  return out;
}

export interface LegendData {
  /** Ends of the scale, mm. */
  readonly limits: readonly [number, number];
  /** The thickness of the selected layer, mm. */
  readonly marked_mm: number | null;
  readonly texts: ViewTexts;
}

/** Ticks of the scale of weights: few enough for languages with a space before the per cent sign. */
const WEIGHTS = [0, 0.5, 1];

const across = (place: number): string => `${(100 * place).toFixed(2)}%`;

/** Sets styles as properties, since a strict content security policy forbids style attributes. */
export function legend({ limits, marked_mm, texts }: LegendData): TemplateResult {
  const [least, greatest] = limits;
  const marks = greatest > least ? [least, ...ticks(limits), greatest] : [least];
  return html`
    <div class="legend" part="legend">
      <span class="heading">${texts.legend}</span>
      <div class="scale" .style=${`background: ${gradient()}`}>
        ${marked_mm === null
          ? nothing
          : html`<i class="mark" .style=${`left: ${across(placeOf(marked_mm, limits))}`}></i>`}
      </div>
      <div class="ticks">
        ${marks.map((mm) => html`<span .style=${`left: ${across(placeOf(mm, limits))}`}>${texts.tick(mm)}</span>`)}
      </div>
    </div>
  `;
}

/** The colour scale of weights, from 0 to 1. */
export function heatLegend(texts: ViewTexts): TemplateResult {
  return html`
    <div class="legend" part="legend">
      <span class="heading">${texts.heat}</span>
      <div class="scale" .style=${`background: ${gradient("to left")}`}></div>
      <div class="ticks">
        ${WEIGHTS.map((weight) => html`<span .style=${`left: ${across(weight)}`}>${texts.weight(weight)}</span>`)}
      </div>
    </div>
  `;
}

/** The colour scale of distances from the model, from 0 to the largest, mm. */
export function distanceLegend(greatest_mm: number, texts: ViewTexts): TemplateResult {
  const marks = greatest_mm > 0 ? [0, ...ticks([0, greatest_mm]), greatest_mm] : [0];
  return html`
    <div class="legend" part="legend">
      <span class="heading">${texts.distance}</span>
      <div class="scale" .style=${`background: ${gradient("to left")}`}></div>
      <div class="ticks">
        ${marks.map((mm) => html`<span .style=${`left: ${across(mm / (greatest_mm || 1))}`}>${texts.tick(mm)}</span>`)}
      </div>
    </div>
  `;
}

export const legendStyles = css`
  .legend {
    display: var(--cusp-view-legend, block);
    position: absolute;
    inset-block-start: calc(0.75rem + var(--cusp-view-head, 0px));
    inset-inline-end: calc(0.75rem + var(--cusp-view-aside, 0px));
    width: 11rem;
    max-width: calc(100% - 1.5rem);
    padding: 0.5rem 0.625rem;
    border: 1px solid var(--cusp-line, color-mix(in srgb, currentColor 18%, transparent));
    border-radius: 8px;
    background: color-mix(in srgb, var(--cusp-card, Canvas) 86%, transparent);
    font-size: 0.75rem;
    line-height: 1.3;
    font-variant-numeric: tabular-nums;
    pointer-events: none;
  }
  .heading {
    color: var(--cusp-quiet, inherit);
  }
  .scale {
    position: relative;
    height: 0.625rem;
    margin-block: 0.375rem 0.125rem;
    border-radius: 3px;
  }
  .mark {
    position: absolute;
    inset-block: -3px;
    width: 2px;
    margin-left: -1px;
    background: var(--cusp-text, CanvasText);
    outline: 1px solid var(--cusp-card, Canvas);
  }
  /* The scale runs from left to right in every script, as charts do. */
  .ticks {
    direction: ltr;
    position: relative;
    height: 1.6em;
    margin-inline: 0.5rem;
  }
  .scale {
    margin-inline: 0.5rem;
  }
  .ticks span {
    position: absolute;
    inset-block-start: 0;
    padding-block-start: 0.25rem;
    transform: translateX(-50%);
    white-space: nowrap;
  }
  .ticks span::before {
    content: "";
    position: absolute;
    inset-block-start: -0.0625rem;
    left: 50%;
    width: 1px;
    height: 0.25rem;
    background: currentColor;
    opacity: 0.5;
  }
  @media (forced-colors: active) {
    .legend {
      background: Canvas;
    }
    .scale {
      forced-color-adjust: none;
      outline: 1px solid CanvasText;
    }
    .mark {
      background: CanvasText;
      outline-color: Canvas;
    }
  }
`;
