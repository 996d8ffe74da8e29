/**
 * Embeds the chart of chart.ts: its size and colours, legend, marker of the selected layer, and input by mouse, touch and keyboard. It
 * fills a box of given height; elsewhere it has its own height.
 */
import { html, nothing, unsafeCSS, type PropertyValues, type TemplateResult } from "lit";
import type uPlot from "uplot";
import uplotStyles from "uplot/dist/uPlot.min.css?inline";
import { chartData, chartOptions, zoomHeights, type ChartData, type ChartTheme, type Heights } from "../parts/chart.js";
import { languageOf } from "../../texts/index.js";
import { layerAt } from "../../view/scene/lookup.js";
import { ZoomGestures } from "../parts/zoom-gestures.js";
import { fetched } from "../parts/fetched.js";
import { partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import { chartStyles } from "../styles/chart-styles.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Position of the chart and the range of heights that it shows. */
export interface PlotPlace {
  /** Plot area, whose vertical extent is the range of heights. */
  over: HTMLElement;
  /** Lowest and highest, mm. */
  heights_mm: Heights;
}

const fetchLibrary = fetched(() => import("uplot"));

/** Zoom factor of a key press. */
const KEY_ZOOM = 1.5;
/** A zoomed chart spans at least this many layers of maximum thickness. */
const LEAST_LAYERS = 4;
/** Number of layers that a page key moves by. */
const PAGE = 10;

/** Least densities of nearly level and of sloping surfaces: the cosine of their slope. */
const SLOPES = [0.9, 0.4] as const;
/** Least changes of outlines that change quickly, and that change at all, as fractions of the largest change. */
const CHANGES = [0.5, 0.1] as const;

type Reason = "level" | "sloping" | "steep" | "quickly" | "slowly" | "hardly";

/** Reason for the thickness of layers at a bin: the slope of the most level surface there, or the change of the outline. */
function reasonOf({ metric, profile }: ChartData, bin: number): Reason {
  const density = (at: number): number => profile[at] ?? 0;
  if (metric === "area" || metric === "volume") {
    // The profile of the volume is the area itself.
    const change = metric === "area" ? density : (at: number) => Math.abs(density(at + 1) - density(at - 1));
    const part = change(bin) / (profile.reduce((most, _, at) => Math.max(most, change(at)), 0) || 1);
    return part >= CHANGES[0] ? "quickly" : part >= CHANGES[1] ? "slowly" : "hardly";
  }
  const slope = metric === "roughness" ? Math.sqrt(Math.max(0, 1 - density(bin) ** -2)) : density(bin);
  return slope >= SLOPES[0] ? "level" : slope >= SLOPES[1] ? "sloping" : "steep";
}

const PROPERTIES = {
  data: given<ChartData | null>(null),
  layer: given(0),
  /** Height range of the chosen finding, mm. */
  mark: given<Heights | null>(null, (a, b) => String(a) !== String(b)),
  language: given(languageOf()),
  zoomed: own(false),
  /** The bin under the pointer, or tapped. */
  hovered: own<number | null>(null),
  /** True if uPlot could not be loaded. */
  failed: own(false),
};

export class CuspChart extends elementWith(PROPERTIES) {
  /** uPlot; null until it is loaded. */
  #library: typeof uPlot | null = null;
  #plot: uPlot | null = null;
  #marker: HTMLElement | null = null;
  #range: HTMLElement | null = null;
  #resized: ResizeObserver | null = null;
  /** The canvas is redrawn when these change the page's colours. */
  readonly #schemes = ["(prefers-color-scheme: dark)", "(forced-colors: active)"].map((query) => matchMedia(query));
  readonly #redraw = (): void => this.#build();
  /** True if the last pointer was a touch: a tapped bin stays, although browsers send a leave event at once. */
  #isTouched = false;
  readonly #gestures = new ZoomGestures({
    shown: () => this.#shown,
    under: (clientY) => this.#under(clientY),
    zoom: (factor, z_mm, place, from) => this.#zoom(factor, z_mm, place, from),
  });

  static override styles = [
    unsafeCSS(uplotStyles),
    shared,
    partStyles,
    chartStyles,
  ];

  override render(): TemplateResult {
    const [min, max] = this.data?.limits ?? [0, 0];
    const { texts, format } = this.language;
    if (this.failed) return html`<div class="head"><h3>${texts.chart.title}</h3></div>${partFailure(this.language, () => void this.#load())}`;
    const words = texts.chart;
    const { data, hovered } = this;
    const isSlider = data !== null;
    const description = this.#words();
    return html`
      <div class="head"><h3>${words.title}</h3></div>
      <div class="top">
        <p>${words.heights}</p>
        <button class="small whole ${this.zoomed ? "" : "off"}" aria-label=${words.whole} title=${words.whole} @click=${this.#showWhole}>
          <svg viewBox="0 0 20 20" aria-hidden="true"><path d="M3 7V3h4m6 0h4v4m0 6v4h-4m-6 0H3v-4" /></svg>
        </button>
      </div>
      <div
        class="plot"
        role=${isSlider ? "slider" : "img"}
        tabindex=${isSlider ? 0 : nothing}
        aria-label=${isSlider ? words.title : description}
        aria-describedby=${isSlider ? "words" : nothing}
        aria-orientation=${isSlider ? "vertical" : nothing}
        aria-valuemin=${isSlider ? 1 : nothing}
        aria-valuemax=${isSlider ? data.thickness_mm.length : nothing}
        aria-valuenow=${isSlider ? this.layer + 1 : nothing}
        aria-valuetext=${isSlider ? this.#value(data) : nothing}
        @keydown=${this.#pressed}
        @pointerdown=${this.#down}
        @pointermove=${this.#gestures.moved}
        @pointerup=${this.#gestures.up}
        @pointercancel=${this.#gestures.up}
        @touchstart=${this.#gestures.touched}
        @touchmove=${this.#gestures.touched}
        @wheel=${this.#gestures.wheeled}
      ></div>
      <p class="visually-hidden" id="words">${description}</p>
      ${data === null
        ? nothing
        : html`<p class="density">${texts.metrics[data.metric].axis}</p>
            <ul class="key">
              <li><span class="line"></span>${words.line}</li>
              <li class="colours">
                ${words.colours}
                <span class="limits figures">${format.tick(min)} <span class="scale"></span> ${format.fine(max)}</span>
              </li>
              ${data.off_mm.length === 0 ? nothing : html`<li><span class="off-mark"></span>${words.off}</li>`}
            </ul>
            <div class="foot figures">
              <p class="mouse ${hovered === null ? "" : "off"}">${words.hint}</p>
              <p class="touch ${hovered === null ? "" : "off"}">${words.touchHint}</p>
              <p>${hovered === null ? nothing : this.#at(data, hovered)}</p>
              <p class="off" aria-hidden="true">${this.#at(data, data.profile.length - 1)}</p>
            </div>`}
    `;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    for (const scheme of this.#schemes) scheme.addEventListener("change", this.#redraw);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const scheme of this.#schemes) scheme.removeEventListener("change", this.#redraw);
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
    else if (changed.has("layer") || changed.has("mark")) {
      this.#reveal();
      this.#mark();
    }
  }

  async #load(): Promise<void> {
    try {
      ({ default: this.#library } = await fetchLibrary());
      this.failed = false;
    } catch (error) {
      // uPlot could not be fetched, or fails in this browser. Everything else works without it.
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

  /** Thickness of the layer at a bin, the height, and the reason. */
  #at(data: ChartData, bin: number): string {
    const { texts, format } = this.language;
    const { bin_mm, z_mm, thickness_mm } = data;
    const height_mm = (bin + 0.5) * bin_mm;
    const thickness = format.fine(thickness_mm[layerAt(z_mm, height_mm)] ?? 0);
    const reason = texts.chart.reasons[reasonOf(data, bin)];
    return texts.chart.because({ thickness, height: format.height(height_mm), reason });
  }

  /** Description of the selected layer. */
  #value({ z_mm, thickness_mm }: ChartData): string {
    const { layer, language: { texts, format } } = this;
    const [z, thickness] = [format.height(z_mm[layer] ?? 0), format.height(thickness_mm[layer] ?? 0)];
    return texts.mask.said({ layer: format.count(layer + 1), layers: format.count(thickness_mm.length), height: z, thickness });
  }

  /** Description of the chart for screen readers. */
  #words(): string {
    const { texts, format } = this.language;
    if (this.data === null) return texts.chart.none;
    const { metric, thickness_mm, z_mm } = this.data;
    const [least, most] = [Math.min(...thickness_mm), Math.max(...thickness_mm)].map((mm) => format.fine(mm)) as [string, string];
    const height = format.height(z_mm.at(-1) ?? 0);
    return texts.chart.said({ axis: texts.metrics[metric].axis, height, layers: thickness_mm.length, least, most });
  }

  readonly #build = (): void => {
    this.#plot?.destroy();
    this.#plot = null;
    this.zoomed = false;
    this.hovered = null;
    this.#gestures.drop();
    const { data } = this;
    const library = this.#library;
    if (library === null || data === null || !this.isConnected) return;
    const frame = this.#frame;
    const options = chartOptions(data, this.#theme(), this.language, [frame.clientWidth, frame.clientHeight]);
    const whole = this.#whole;
    options.hooks = {
      ...options.hooks,
      // When uPlot draws, initially or after a zoom, its scales are set.
      draw: [
        ...(options.hooks?.draw ?? []),
        (u) => {
          const { min, max } = u.scales["x"] ?? {};
          this.zoomed = min != null && max != null && max - min < 0.99 * whole;
          this.#mark();
          if (min != null && max != null) this.#place([min, max]);
        },
      ],
      setCursor: [
        (u) => {
          const bin = u.cursor.idx ?? null;
          if (bin !== null || !this.#isTouched) this.hovered = bin;
        },
      ],
    };
    this.#plot = new library(options, chartData(data), frame);
    this.#place([0, whole]);
    this.#marker = document.createElement("div");
    this.#marker.className = "marker";
    this.#range = document.createElement("div");
    this.#range.className = "range";
    this.#plot.over.append(this.#range, this.#marker);
    this.#plot.over.addEventListener("click", this.#clicked);
    this.#mark();
  };

  /** Reports the chart's position and heights to the neighbouring view, which aligns with them. */
  #place(heights_mm: Heights): void {
    if (this.#plot === null) return;
    const detail: PlotPlace = { over: this.#plot.over, heights_mm };
    this.dispatchEvent(new CustomEvent<PlotPlace>("cusp-plot", { detail }));
  }

  readonly #down = (event: PointerEvent): void => {
    this.#isTouched = event.pointerType === "touch";
    this.#gestures.down(event);
  };

  readonly #clicked = (event: MouseEvent): void => {
    if (this.data === null) return;
    const [, z] = this.#under(event.clientY);
    this.hovered = Math.min(this.data.profile.length - 1, Math.max(0, Math.floor(z / this.data.bin_mm)));
    this.#select(layerAt(this.data.z_mm, z));
  };

  #select(layer: number): void {
    this.dispatchEvent(new CustomEvent<number>("cusp-layer", { detail: layer }));
  }

  /** Height of the profile, mm. */
  get #whole(): number {
    return this.data === null ? 0 : this.data.profile.length * this.data.bin_mm;
  }

  /** Visible range of heights. */
  get #shown(): Heights {
    const { min, max } = this.#plot?.scales["x"] ?? {};
    return min == null || max == null ? [0, this.#whole] : [min, max];
  }

  /** Middle of the selected layer, mm. */
  get #middle(): number {
    const { data, layer } = this;
    return data === null ? 0 : ((data.z_mm[layer] ?? 0) + (data.z_mm[layer + 1] ?? 0)) / 2;
  }

  /** Shows the heights `from`, zoomed by a factor so that `z_mm` is at `place`; see {@link zoomHeights}. */
  #zoom(factor: number, z_mm: number, place: number, from = this.#shown): void {
    const thickest_mm = this.data?.limits[1] ?? 0;
    const [min, max] = zoomHeights(from, factor, z_mm, place, this.#whole, Math.min(this.#whole, LEAST_LAYERS * thickest_mm));
    this.#plot?.setScale("x", { min, max });
  }

  /** Position of a screen point in the plot, 0 at the lower and 1 at the upper edge, and its height. */
  #under(clientY: number): [place: number, z_mm: number] {
    const { bottom = 0, height = 1 } = this.#plot?.over.getBoundingClientRect() ?? {};
    const [low, high] = this.#shown;
    const place = (bottom - clientY) / height;
    return [place, low + place * (high - low)];
  }

  /** Scrolls zoomed heights to the selected layer. */
  #reveal(): void {
    const [low, high] = this.#shown;
    if (this.#middle < low || this.#middle > high) this.#zoom(1, this.#middle, 0.5);
  }

  readonly #showWhole = (): void => {
    // The reset button disappears, so the focus moves.
    this.#frame.focus({ preventScroll: true });
    this.#plot?.setScale("x", { min: 0, max: this.#whole });
  };

  readonly #pressed = (event: KeyboardEvent): void => {
    const { data, layer } = this;
    if (data === null || event.ctrlKey || event.metaKey || event.altKey) return;
    const last = data.thickness_mm.length - 1;
    const [low, high] = this.#shown;
    // Zooms around the selected layer, which #reveal keeps visible.
    const zoom = (factor: number): void => this.#zoom(factor, this.#middle, (this.#middle - low) / (high - low));
    const move = (to: number): void => this.#select(Math.min(last, Math.max(0, to)));
    const actions: Partial<Record<string, () => void>> = {
      ArrowUp: () => move(layer + 1),
      ArrowRight: () => move(layer + 1),
      ArrowDown: () => move(layer - 1),
      ArrowLeft: () => move(layer - 1),
      PageUp: () => move(layer + PAGE),
      PageDown: () => move(layer - PAGE),
      Home: () => move(0),
      End: () => move(last),
      "+": () => zoom(KEY_ZOOM),
      "=": () => zoom(KEY_ZOOM),
      "-": () => zoom(1 / KEY_ZOOM),
      "0": this.#showWhole,
    };
    const action = actions[event.key];
    if (action === undefined) return;
    event.preventDefault();
    action();
  };

  #fit(): void {
    const { clientWidth, clientHeight } = this.#frame;
    if (this.#plot === null || clientWidth === 0) return;
    if (this.#plot.width === clientWidth && this.#plot.height === clientHeight) return;
    this.#plot.setSize({ width: clientWidth, height: clientHeight });
    this.#mark();
  }

  #mark(): void {
    const [plot, marker] = [this.#plot, this.#marker];
    if (plot === null || marker === null || this.data === null) return;
    this.#span(plot);
    const top = plot.valToPos(this.#middle, "x");
    marker.hidden = !(top >= 0 && top <= plot.over.clientHeight);
    marker.style.transform = `translateY(${Math.round(top) - 1}px)`;
  }

  /** Marks the visible heights of the chosen finding. */
  #span(plot: uPlot): void {
    const [range, mark] = [this.#range, this.mark];
    if (range === null) return;
    const end = plot.over.clientHeight;
    const [bottom, top] = (mark ?? [0, 0]).map((z_mm) => Math.min(end, Math.max(0, plot.valToPos(z_mm, "x")))) as [number, number];
    range.hidden = mark === null || (bottom === top && (top === 0 || top === end));
    range.style.top = `${top}px`;
    range.style.height = `${Math.max(2, bottom - top)}px`;
  }

  #theme(): ChartTheme {
    const style = getComputedStyle(this);
    // Canvas does not accept `light-dark()`, so an element resolves each custom property.
    const probe = document.createElement("span");
    probe.style.setProperty("forced-color-adjust", "none");
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
      bad: colour("bad"),
      font: style.fontFamily,
    };
    probe.remove();
    return theme;
  }
}

