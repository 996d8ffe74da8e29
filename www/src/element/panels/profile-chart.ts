/** Puts the chart of chart.ts on the page: its size and colours, the marker of the selected layer, and clicks. */
import { css, html, unsafeCSS, type PropertyValues, type TemplateResult } from "lit";
import type uPlot from "uplot";
import uplotStyles from "uplot/dist/uPlot.min.css?inline";
import { chartData, chartOptions, type ChartData, type ChartTheme } from "../parts/chart.js";
import { gradient } from "../../view/legend/palette.js";
import { languageOf } from "../../texts/index.js";
import { layerAt } from "../../view/scene/lookup.js";
import { METRICS } from "../state/metric.js";
import { partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** The position of the chart and the heights that it shows. */
export interface PlotPlace {
  /** The plot area; the heights span it from its lower to its upper edge. */
  over: HTMLElement;
  /** Lowest and highest, mm. */
  heights_mm: readonly [number, number];
}

const PROPERTIES = {
  data: given<ChartData | null>(null),
  layer: given(0),
  language: given(languageOf()),
  zoomed: own(false),
  /** The bin under the pointer. */
  hovered: own<number | null>(null),
  /** Whether uPlot could not be loaded. */
  failed: own(false),
};

export class CuspChart extends elementWith(PROPERTIES) {
  /** uPlot; null until it is loaded. */
  #library: typeof uPlot | null = null;
  #plot: uPlot | null = null;
  #marker: HTMLElement | null = null;
  #resized: ResizeObserver | null = null;
  readonly #dark = matchMedia("(prefers-color-scheme: dark)");
  readonly #redraw = (): void => this.#build();

  static override styles = [
    unsafeCSS(uplotStyles),
    shared,
    partStyles,
    css`
      :host {
        display: block;
        min-width: 0;
      }
      .legend {
        display: flex;
        white-space: nowrap;
        align-items: center;
        gap: 0.5rem;
        font-size: 0.8125rem;
        color: var(--cusp-quiet);
      }
      .scale {
        background: ${unsafeCSS(gradient("classic"))};
        width: 5rem;
        height: 0.625rem;
        border-radius: 3px;
      }
      .plot {
        direction: ltr;
        height: 30rem;
        overflow: hidden;
      }
      .u-over {
        cursor: crosshair;
        border-radius: 2px;
      }
      .u-select {
        background: rgb(16 19 26 / 0.25);
      }
      .marker {
        position: absolute;
        left: -5px;
        right: -5px;
        height: 0;
        border-top: 2px solid var(--cusp-chart-ink);
        outline: 1px solid var(--cusp-chart-paper);
        pointer-events: none;
      }
      .marker::before {
        content: "";
        position: absolute;
        left: -3px;
        top: -6px;
        border: 5px solid transparent;
        border-left: 7px solid var(--cusp-text);
      }
      @media (max-width: 640px) {
        .plot {
          height: 24rem;
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const [min, max] = this.data?.limits ?? [0, 0];
    const { texts, format } = this.language;
    if (this.failed) return html`<div class="head"><h3>${texts.chart.title}</h3></div>${partFailure(this.language, () => void this.#load())}`;
    return html`
      <div class="head">
        <h3>${texts.chart.title}</h3>
        <div class="legend figures">
          <span>${format.fine(min)}</span>
          <span class="scale"></span>
          <span>${format.fine(max)}</span>
        </div>
      </div>
      <div class="plot" role="img" aria-label=${this.#words()}></div>
      <div class="foot">
        <p class="quiet figures">${this.#hint()}</p>
        ${this.zoomed ? html`<button class="small" @click=${this.#build}>${texts.chart.whole}</button>` : ""}
      </div>
    `;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#dark.addEventListener("change", this.#redraw);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#dark.removeEventListener("change", this.#redraw);
    this.#resized?.disconnect();
    this.#resized = null;
    this.#plot?.destroy();
    this.#plot = null;
  }

  override firstUpdated(): void {
    void this.#load();
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("data") || changed.has("language")) this.#build();
    else if (changed.has("layer")) this.#mark();
  }

  async #load(): Promise<void> {
    try {
      ({ default: this.#library } = await import("uplot"));
      this.failed = false;
    } catch (error) {
      // uPlot could not be fetched, or does not start in this browser. Everything else works without it.
      this.failed = true;
      tellPartFailed(this, "chart", error);
      return;
    }
    await this.updateComplete;
    if (!this.isConnected) return;
    this.#resized = new ResizeObserver(() => this.#fit());
    this.#resized.observe(this.#frame);
    this.#build();
  }

  get #frame(): HTMLElement {
    const frame = this.renderRoot.querySelector<HTMLElement>(".plot");
    if (frame === null) throw new Error("the chart is not on the page");
    return frame;
  }

  /** The value under the pointer, or a hint at what the pointer can do. */
  #hint(): string {
    const { data, hovered } = this;
    const density = hovered === null ? undefined : data?.profile[hovered];
    const { texts, format } = this.language;
    if (data === null || hovered === null || density === undefined) return texts.chart.hint;
    const value = METRICS[data.metric].density(density, format);
    return texts.chart.at(format.height((hovered + 0.5) * data.bin_mm), texts.metrics[data.metric].density(value));
  }

  /** The chart in words, for screen readers. */
  #words(): string {
    const { texts, format } = this.language;
    if (this.data === null) return texts.chart.none;
    const { metric, thickness_mm, z_mm } = this.data;
    const [least, most] = [Math.min(...thickness_mm), Math.max(...thickness_mm)].map((mm) => format.fine(mm)) as [string, string];
    const height = format.height(z_mm.at(-1) ?? 0);
    return texts.chart.said(texts.metrics[metric].axis, height, thickness_mm.length, least, most);
  }

  readonly #build = (): void => {
    this.#plot?.destroy();
    this.#plot = null;
    this.zoomed = false;
    this.hovered = null;
    const { data } = this;
    const library = this.#library;
    if (library === null || data === null || !this.isConnected) return;
    const frame = this.#frame;
    const options = chartOptions(data, this.#theme(), this.language, [frame.clientWidth, frame.clientHeight]);
    const whole = data.profile.length * data.bin_mm;
    options.hooks = {
      ...options.hooks,
      // When uPlot draws, initially or after a zoom, its scales are settled.
      draw: [
        (u) => {
          const { min, max } = u.scales["x"] ?? {};
          this.zoomed = min != null && max != null && max - min < 0.99 * whole;
          this.#mark();
          if (min != null && max != null) this.#place([min, max]);
        },
      ],
      setCursor: [
        (u) => {
          this.hovered = u.cursor.idx ?? null;
        },
      ],
    };
    this.#plot = new library(options, chartData(data), frame);
    this.#place([0, whole]);
    this.#marker = document.createElement("div");
    this.#marker.className = "marker";
    this.#plot.over.append(this.#marker);
    this.#plot.over.addEventListener("click", this.#clicked);
    this.#mark();
  };

  /** Reports the chart's position and heights to the view beside it, which aligns with them. */
  #place(heights_mm: readonly [number, number]): void {
    if (this.#plot === null) return;
    const detail: PlotPlace = { over: this.#plot.over, heights_mm };
    this.dispatchEvent(new CustomEvent<PlotPlace>("cusp-plot", { detail }));
  }

  readonly #clicked = (event: MouseEvent): void => {
    const plot = this.#plot;
    if (plot === null || this.data === null) return;
    const z = plot.posToVal(event.clientY - plot.over.getBoundingClientRect().top, "x");
    this.dispatchEvent(new CustomEvent<number>("cusp-layer", { detail: layerAt(this.data.z_mm, z) }));
  };

  #fit(): void {
    const { clientWidth, clientHeight } = this.#frame;
    if (this.#plot === null || clientWidth === 0) return;
    if (this.#plot.width === clientWidth && this.#plot.height === clientHeight) return;
    this.#plot.setSize({ width: clientWidth, height: clientHeight });
    this.#mark();
  }

  #mark(): void {
    const [plot, marker, data] = [this.#plot, this.#marker, this.data];
    if (plot === null || marker === null || data === null) return;
    const middle = ((data.z_mm[this.layer] ?? 0) + (data.z_mm[this.layer + 1] ?? 0)) / 2;
    const top = plot.valToPos(middle, "x");
    marker.hidden = !(top >= 0 && top <= plot.over.clientHeight);
    marker.style.transform = `translateY(${Math.round(top) - 1}px)`;
  }

  #theme(): ChartTheme {
    const style = getComputedStyle(this);
    // A canvas does not accept `light-dark()`: let an element resolve each custom property.
    const probe = document.createElement("span");
    this.#frame.append(probe);
    const colour = (name: string): string => {
      probe.style.color = `var(--cusp-${name})`;
      return getComputedStyle(probe).color;
    };
    const theme = {
      ink: colour("chart-ink"),
      text: colour("text"),
      grid: colour("field"),
      paper: colour("chart-paper"),
      seam: colour("chart-seam"),
      font: style.fontFamily,
    };
    probe.remove();
    return theme;
  }
}

