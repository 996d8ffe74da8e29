/** Vertical layer slider with the height of the neighbouring plot: its thumb is at the height of the layer. */
import { css, html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { PlotPlace } from "../element/panels/profile-chart.js";
import type { Shown } from "../element/state/result.js";
import { shared } from "../element/styles/shared.js";
import { languageOf } from "../texts/index.js";
import { workbenchWords } from "./texts.js";
import { elementWith, given, own } from "../view/properties.js";
import { layerAt } from "../view/scene/lookup.js";

/** Number of layers that a key moves by. */
const STEPS: Readonly<Record<string, number>> = {
  ArrowUp: 1,
  ArrowRight: 1,
  ArrowDown: -1,
  ArrowLeft: -1,
  PageUp: 10,
  PageDown: -10,
  Home: Number.NEGATIVE_INFINITY,
  End: Number.POSITIVE_INFINITY,
};

/** Height of the thumb in pixels, by which the slider is longer than its span. */
const THUMB_PX = 16;

interface Span {
  top_px: number;
  bottom_px: number;
}

/** Position of the slider without a neighbouring plot. */
const ALONE: Span = { top_px: THUMB_PX, bottom_px: THUMB_PX };

const PROPERTIES = {
  shown: given<Shown | null>(null),
  layer: given(0),
  /** The neighbouring plot, with the heights that it shows; null without one. */
  plot: given<PlotPlace | null>(null),
  language: given(languageOf()),
  span: own(ALONE),
};

export class CuspLayerSlider extends elementWith(PROPERTIES) {
  readonly #resized = new ResizeObserver(() => this.#measure());
  #over: HTMLElement | null = null;

  static override styles = [
    shared,
    css`
      :host {
        position: relative;
        display: block;
        width: 2.75rem;
        touch-action: none;
      }
      input {
        position: absolute;
        left: 0;
        width: 100%;
        margin: 0;
        writing-mode: vertical-lr;
        direction: rtl;
        appearance: none;
        background: transparent;
        cursor: ns-resize;
        touch-action: none;
      }
      input::-webkit-slider-runnable-track {
        width: 4px;
        margin-inline: auto;
        border-radius: 2px;
        background: var(--cusp-line);
      }
      input::-moz-range-track {
        width: 4px;
        border-radius: 2px;
        background: var(--cusp-line);
      }
      input::-webkit-slider-thumb {
        appearance: none;
        width: 28px;
        height: 16px;
        margin-left: -12px;
        border: 2px solid var(--cusp-card);
        border-radius: 8px;
        background: var(--cusp-accent);
      }
      input::-moz-range-thumb {
        box-sizing: border-box;
        width: 28px;
        height: 16px;
        border: 2px solid var(--cusp-card);
        border-radius: 8px;
        background: var(--cusp-accent);
      }
      /* A list of selectors with one that an engine does not know is no rule at all: hence each twice. */
      @media (forced-colors: active) {
        input {
          forced-color-adjust: none;
        }
        input::-webkit-slider-runnable-track {
          background: CanvasText;
        }
        input::-moz-range-track {
          background: CanvasText;
        }
        input::-webkit-slider-thumb {
          border-color: Canvas;
          background: Highlight;
        }
        input::-moz-range-thumb {
          border-color: Canvas;
          background: Highlight;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.#resized.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#resized.disconnect();
    this.#over = null;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("plot")) return;
    const over = this.plot?.over ?? null;
    if (over === this.#over) return;
    if (this.#over !== null) this.#resized.unobserve(this.#over);
    if (over !== null) this.#resized.observe(over);
    this.#over = over;
  }

  override render(): TemplateResult | typeof nothing {
    const { shown, layer, plot, span } = this;
    const { texts, format } = this.language;
    const layers = shown?.thickness_mm.length ?? 0;
    if (shown === null || layers === 0) return nothing;
    const { z_mm, thickness_mm } = shown;
    const [bottom, top] = [z_mm[layer] ?? 0, z_mm[layer + 1] ?? 0];
    const [least, most] = plot?.heights_mm ?? [0, z_mm.at(-1) ?? 0];
    const said = texts.mask.said({
      layer: format.count(layer + 1),
      layers: format.count(layers),
      height: format.height(bottom),
      thickness: format.height(thickness_mm[layer] ?? top - bottom),
    });
    return html`<input
      type="range"
      aria-label=${workbenchWords(this.language).layer}
      aria-orientation="vertical"
      aria-valuetext=${said}
      min=${least}
      max=${most}
      step="any"
      .style=${`top: ${span.top_px - THUMB_PX / 2}px; bottom: ${span.bottom_px - THUMB_PX / 2}px`}
      .value=${live(String((bottom + top) / 2))}
      @input=${({ target }: Event) => this.#go(layerAt(z_mm, Number((target as HTMLInputElement).value)))}
      @keydown=${this.#key}
    />`;
  }

  readonly #key = (event: KeyboardEvent): void => {
    const step = STEPS[event.key];
    if (step === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const last = (this.shown?.thickness_mm.length ?? 1) - 1;
    this.#go(Math.min(Math.max(0, this.layer + step), last));
  };

  #go(layer: number): void {
    this.dispatchEvent(new CustomEvent<number>("cusp-layer", { detail: layer }));
    // Resets the thumb, which browsers leave at the pointer, between two layers.
    this.requestUpdate();
  }

  #measure(): void {
    const over = this.#over?.getBoundingClientRect();
    // A plot that has gone is replaced by the next plan.
    if (over?.height === 0) return;
    const own = this.getBoundingClientRect();
    const span = over === undefined ? ALONE : { top_px: over.top - own.top, bottom_px: own.bottom - over.bottom };
    if (span.top_px !== this.span.top_px || span.bottom_px !== this.span.bottom_px) this.span = span;
  }
}
