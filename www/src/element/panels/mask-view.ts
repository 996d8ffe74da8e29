/** Layer mask on a zoomable canvas, with a layer slider and a play button. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { Mask } from "../../api/index.js";
import type { Finding, Report } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { maskingTexts } from "../../texts/masking.js";
import { coverage, factorFor, litPixels, wholeBytes, type Rectangle } from "../parts/bitmap.js";
import { css as cssColour, ofThickness } from "../../view/legend/palette.js";
import { drawnButton } from "../parts/icon-button.js";
import { styled } from "../parts/styled.js";
import { maskStyles } from "../styles/mask-styles.js";
import { shared } from "../styles/shared.js";
import { dragged, fitted, moved, WHOLE, windowOf, zoomed, type Point } from "../parts/window.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Minimum time between two layers during playback; the second value is for reduced motion. */
const FRAME_MS = 60;
const CALM_FRAME_MS = 400;

/** Distance that an arrow key moves the picture, as a fraction of the visible part. */
const STEP = 0.125;

/** Box around a finding: its colour, which no mask contains, and its margin in CSS pixels. */
const MARK_COLOUR = "#ff9f1a";
const MARK_ROOM_PX = 4;

/** SVG paths in a square of 20 units. */
const ICONS = {
  fit: "M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M7 7h6v6H7z",
  measure: "M2.5 13.5 13.5 2.5l4 4-11 11zM6 10l1.5 1.5M8.5 7.5 11 10M11 5l1.5 1.5",
  changes: "M3 3h9v9H3zM8 8h9v9H8z",
  full: "M3 8V3h5M12 3h5v5M17 12v5h-5M8 17H3v-5",
} as const;

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-STEP, 0],
  ArrowRight: [STEP, 0],
  ArrowUp: [0, -STEP],
  ArrowDown: [0, STEP],
};

/** The fields of a report that the panel reads; a print file provides them too. */
export interface Layered extends Pick<Report, "layers" | "z_mm" | "thickness_mm"> {
  mask: Pick<Report["mask"], "pitch_mm" | "pitch_y_mm">;
  /** Exposure of each layer, if known. */
  exposure_s?: readonly number[];
}

type Place = Pick<Finding, "bounds_mm" | "layers">;

const PROPERTIES = {
  mask: given<Mask | null>(null),
  /** Mask of the layer below, for the changes; null until known, undefined if the host knows none. */
  below: given<Mask | null | undefined>(undefined),
  /** Width and depth of what is printed in the middle of the mask, mm; null: the whole mask is shown first. */
  extent_mm: given<readonly number[] | null>(null),
  report: given<Layered | null>(null),
  limits: given<readonly [number, number]>([0, 0]),
  layer: given(0),
  /** Pull of the film at each layer, N; empty until known, null if the host never knows it. */
  pull_n: given<readonly number[] | null>(null),
  /** The chosen finding, in its layers on each copy. */
  marks: given<readonly Place[]>([]),
  /** All findings, likewise. */
  places: given<readonly Place[]>([]),
  language: given(languageOf()),
  place: own(WHOLE),
  playing: own(false),
  /** True while changes from the layer below are shown. */
  showsChanges: own(false),
  isMeasuring: own(false),
  /** Ends of the line that is measured, mm from the middle of the mask; the second follows the pointer at first. */
  ruler: own<readonly Point[]>([]),
};

export class CuspMask extends elementWith(PROPERTIES) {
  #resized: ResizeObserver | null = null;
  /** Number of lit pixels of the mask. */
  #lit = 0;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Pointers on the picture, by id: one drags, two zoom. */
  readonly #held = new Map<number, Point>();
  /** True between the two presses of a measurement. */
  #isRuling = false;
  /** True once the picture was fitted to the model. */
  #isFitted = false;
  readonly #calm = matchMedia("(prefers-reduced-motion: reduce)");

  static override styles = [shared, maskStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.hasUpdated) this.#watch();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#resized?.disconnect();
    this.#stop();
  }

  override firstUpdated(): void {
    this.addEventListener("fullscreenchange", () => this.requestUpdate());
    this.#watch();
  }

  override render(): TemplateResult {
    const { report, layer, place } = this;
    const { texts, format } = this.language;
    const words = texts.mask;
    const layers = report?.layers ?? 1;
    const z = format.height(report?.z_mm[layer] ?? 0);
    const thickness_mm = report?.thickness_mm[layer] ?? 0;
    const thickness = format.height(thickness_mm);
    const said = words.said({ layer: format.count(layer + 1), layers: format.count(layers), height: z, thickness });
    const isZoomed = place.zoom > 1;
    // A two-finger zoom is not a whole number.
    const zoom = place.zoom < 10 ? format.tick(Math.round(place.zoom * 10) / 10) : format.count(place.zoom);
    const more = maskingTexts(this.language);
    const exposure_s = report?.exposure_s?.[layer];
    return html`
      <div class="head"><h3>${words.title}</h3></div>
      <div class="well">
        <canvas
          class=${this.isMeasuring ? "measuring" : isZoomed ? "zoomed" : ""}
          role="img"
          tabindex=${isZoomed ? 0 : -1}
          aria-label=${words.picture({ said }) + (isZoomed ? `. ${words.wellHint}` : "")}
          @keydown=${this.#key}
          @dblclick=${this.#zoomHere}
          @touchstart=${this.#touch}
          @touchmove=${this.#touch}
          @pointerdown=${this.#grab}
          @pointermove=${this.#pull}
          @pointerup=${this.#release}
          @pointercancel=${this.#release}
        ></canvas>
        <div class="tools">
          ${this.extent_mm === null ? nothing : drawnButton(ICONS.fit, more.fit, this.#fit)}
          ${drawnButton(ICONS.measure, more.measure, this.#measure, true, this.isMeasuring)}
          ${this.below === undefined ? nothing : drawnButton(ICONS.changes, more.changes, this.#seeChanges, true, this.showsChanges)}
          ${document.fullscreenEnabled ? drawnButton(ICONS.full, more.full, this.#fill, true, document.fullscreenElement !== null) : nothing}
          ${isZoomed ? html`<span class="zoom figures">${words.zoom({ times: zoom })}</span>` : nothing}
          <button class="small" aria-label=${words.zoomOut} ?disabled=${!isZoomed} @click=${() => this.#zoom(0.5)}>−</button>
          <button class="small" aria-label=${words.zoomIn} @click=${() => this.#zoom(2)}>+</button>
        </div>
      </div>
      ${this.showsChanges ? html`<p class="changes"><span><i class="grown"></i>${more.grown}</span><span><i class="gone"></i>${more.gone}</span></p>` : nothing}
      <p class="hint quiet">
        <span class=${isZoomed ? "off" : ""}>${words.hint}</span>
        <span class="hovers ${isZoomed ? "" : "off"}">${words.wellHint}</span>
        <span class="taps ${isZoomed ? "" : "off"}">${words.touchHint}</span>
      </p>
      <div class="scrub">
        <button aria-label=${this.playing ? words.pause : words.play} @click=${this.#toggle}>
          <svg viewBox="0 0 16 16" aria-hidden="true">
            <path d=${this.playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 1.5v13l11-6.5z"} />
          </svg>
        </button>
        <button aria-label=${words.below} ?disabled=${layer <= 0} @click=${() => this.#go(layer - 1)}>−</button>
        <input
          type="range"
          aria-label=${words.layer}
          aria-valuetext=${said}
          min="1"
          max=${layers}
          step="1"
          .value=${live(String(layer + 1))}
          @input=${(event: Event) => this.#go(Number((event.target as HTMLInputElement).value) - 1)}
        />
        <button aria-label=${words.above} ?disabled=${layer >= layers - 1} @click=${() => this.#go(layer + 1)}>+</button>
      </div>
      <dl class="figures">
        <div>
          <dt>${words.layer}</dt>
          <dd>${format.count(layer + 1)} / ${format.count(layers)}</dd>
        </div>
        <div>
          <dt>${words.height}</dt>
          <dd>${z}</dd>
        </div>
        <div>
          <dt>${words.thickness}</dt>
          <dd>
            <span class="swatch" ${styled({ background: cssColour(ofThickness(thickness_mm, this.limits)) })}></span
            >${thickness}
          </dd>
        </div>
        ${exposure_s === undefined || Number.isNaN(exposure_s) ? nothing : html`<div><dt>${more.exposure}</dt><dd>${format.measure(exposure_s, "s")}</dd></div>`}
        <div><dt>${more.area}</dt><dd>${this.#area()}</dd></div>
        ${this.pull_n === null ? nothing : html`<div title=${more.pullHelp}><dt>${more.pull}</dt><dd>${this.#force(this.pull_n)}</dd></div>`}
      </dl>
    `;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("mask") && this.mask !== null) this.#lit = litPixels(this.mask.bits);
  }

  override updated(changed: PropertyValues<this>): void {
    if (!this.#isFitted && this.mask !== null && this.extent_mm !== null) {
      this.#isFitted = true;
      this.#fit();
    }
    if ((["mask", "below", "place", "marks", "places", "showsChanges", "ruler"] as const).some((name) => changed.has(name))) this.#paint();
    if (this.playing && changed.has("mask")) this.#next();
  }

  get #canvas(): HTMLCanvasElement {
    const canvas = this.renderRoot.querySelector("canvas");
    if (canvas === null) throw new Error("the mask has no canvas");
    return canvas;
  }

  #watch(): void {
    this.#resized ??= new ResizeObserver(() => this.#paint());
    this.#resized.observe(this.#canvas);
  }

  #paint(): void {
    const canvas = this.#canvas;
    const { mask, report } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((css) => Math.round(css * devicePixelRatio));
    const pen = canvas.getContext("2d");
    if (pen === null || !width || !height) return;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    pen.clearRect(0, 0, width, height);
    if (mask === null || report === null) {
      canvas.removeAttribute("data-layer");
      return;
    }
    const { part, scale } = windowOf(this.place, [mask.width, mask.height], [width, height], pitchOf(report));
    const whole = wholeBytes(part, mask.width, mask.height);
    const factor = factorFor(Math.max(...scale));
    const { below } = this;
    const isChanged = this.showsChanges && below?.layer === mask.layer - 1 && below.bits.length === mask.bits.length;
    const beneath = isChanged ? coverage(below.bits, mask.width, whole, factor).values : null;
    const picture = pictureOf(coverage(mask.bits, mask.width, whole, factor), beneath);
    if (picture !== null) {
      pen.imageSmoothingEnabled = factor * Math.max(...scale) < 1;
      const [x, y] = [(whole.x - part.x) * scale[0], (whole.y - part.y) * scale[1]];
      pen.drawImage(picture, x, y, picture.width * factor * scale[0], picture.height * factor * scale[1]);
    }
    this.#mark(pen, part, scale);
    this.#rule(pen, part, scale);
    // The layer painted, which may lag behind the slider.
    canvas.dataset["layer"] = String(mask.layer);
  }

  /** Draws boxes around the findings that the painted layer contains, a bold one around the chosen finding. */
  #mark(pen: CanvasRenderingContext2D, part: Rectangle, scale: readonly [number, number]): void {
    const { mask, report } = this;
    if (mask === null || report === null) return;
    const isHere = ({ layers: [first, last] }: Place): boolean => mask.layer >= first && mask.layer <= last;
    const [marks, places] = [this.marks.filter(isHere), this.places.filter(isHere)];
    this.#canvas.toggleAttribute("data-marked", marks.length > 0);
    this.#canvas.dataset["places"] = String(places.length);
    const at = (x_mm: number, y_mm: number): Point => screenOf([x_mm, y_mm], mask, report, part, scale);
    const room = MARK_ROOM_PX * devicePixelRatio;
    const outline = ({ bounds_mm: [[left, front], [right, back]] }: Place, colour: string, width: number): void => {
      const [[x0, y0], [x1, y1]] = [at(left, back), at(right, front)];
      pen.strokeStyle = colour;
      pen.lineWidth = width * devicePixelRatio;
      pen.strokeRect(x0 - room, y0 - room, x1 - x0 + 2 * room, y1 - y0 + 2 * room);
    };
    for (const place of places) outline(place, MARK_COLOUR, 1);
    for (const mark of marks) {
      outline(mark, "#000", 4);
      outline(mark, MARK_COLOUR, 2);
    }
  }

  /** Draws the line that is measured, with its length. */
  #rule(pen: CanvasRenderingContext2D, part: Rectangle, scale: readonly [number, number]): void {
    const { mask, report, ruler: [from, to] } = this;
    if (mask === null || report === null || from === undefined || to === undefined) return;
    const [[x0, y0], [x1, y1]] = [screenOf(from, mask, report, part, scale), screenOf(to, mask, report, part, scale)];
    pen.lineWidth = 2 * devicePixelRatio;
    pen.strokeStyle = MARK_COLOUR;
    pen.beginPath();
    pen.moveTo(x0, y0);
    pen.lineTo(x1, y1);
    pen.stroke();
    const length = this.language.format.mm(Math.round(100 * Math.hypot(to[0] - from[0], to[1] - from[1])) / 100);
    pen.font = `600 ${13 * devicePixelRatio}px system-ui, sans-serif`;
    pen.lineWidth = 4 * devicePixelRatio;
    pen.strokeStyle = "#000";
    pen.fillStyle = "#fff";
    const [x, y] = [(x0 + x1) / 2 + 6 * devicePixelRatio, (y0 + y1) / 2 - 6 * devicePixelRatio];
    pen.strokeText(length, x, y);
    pen.fillText(length, x, y);
    this.#canvas.dataset["length"] = length;
  }

  /** Area of the lit pixels, in words. */
  #area(): string {
    const { mask, report } = this;
    if (mask === null || report === null) return "–";
    const mm2 = this.#lit * report.mask.pitch_mm * report.mask.pitch_y_mm;
    return `${this.language.format.exact(Number(mm2.toPrecision(3)))}\u00a0mm²`;
  }

  #force(pull_n: readonly number[]): string {
    const newtons = pull_n[this.layer];
    return newtons === undefined ? "–" : `${this.language.format.exact(Number(newtons.toPrecision(2)))}\u00a0N`;
  }

  readonly #fit = (): void => {
    const { mask, report, extent_mm } = this;
    const { clientWidth, clientHeight } = this.#canvas;
    const [width_mm = 0, depth_mm = 0] = extent_mm ?? [];
    if (mask === null || report === null || clientWidth === 0 || width_mm <= 0) return;
    const extent = [width_mm / report.mask.pitch_mm, depth_mm / report.mask.pitch_y_mm] as const;
    this.place = fitted(extent, [mask.width, mask.height], [clientWidth, clientHeight], pitchOf(report));
  };

  readonly #measure = (): void => {
    this.isMeasuring = !this.isMeasuring;
    this.ruler = [];
  };

  readonly #seeChanges = (): void => {
    this.showsChanges = !this.showsChanges;
    this.dispatchEvent(new CustomEvent<boolean>("cusp-changes", { detail: this.showsChanges }));
  };

  readonly #fill = (): void => {
    // If the browser refuses, nothing changes.
    (document.fullscreenElement === null ? this.requestFullscreen() : document.exitFullscreen()).catch(() => undefined);
  };

  /** Place of a pointer, mm from the middle of the mask. */
  #millimetres(event: PointerEvent): Point | null {
    const { mask, report } = this;
    if (mask === null || report === null) return null;
    const [x, y] = this.#pointOf(event);
    const { clientWidth, clientHeight } = this.#canvas;
    const { part } = windowOf(this.place, [mask.width, mask.height], [clientWidth, clientHeight], pitchOf(report));
    const { pitch_mm, pitch_y_mm } = report.mask;
    return [(part.x + x * part.width - mask.width / 2) * pitch_mm, (mask.height / 2 - part.y - y * part.height) * pitch_y_mm];
  }

  #go(layer: number): void {
    this.dispatchEvent(new CustomEvent<number>("cusp-layer", { detail: layer }));
  }

  #zoom(times: number): void {
    this.place = zoomed(this.place, times);
  }

  readonly #toggle = (): void => {
    if (this.playing) return this.#stop();
    this.playing = true;
    // At the top layer, playback starts again from the first.
    if (this.layer >= (this.report?.layers ?? 1) - 1) this.#go(0);
    else this.#next();
  };

  /** Schedules the layer above, now that this one is painted. */
  #next(): void {
    clearTimeout(this.#timer);
    if (this.layer >= (this.report?.layers ?? 1) - 1) return this.#stop();
    this.#timer = setTimeout(() => this.#go(this.layer + 1), this.#calm.matches ? CALM_FRAME_MS : FRAME_MS);
  }

  #stop(): void {
    clearTimeout(this.#timer);
    this.playing = false;
  }

  readonly #key = (event: KeyboardEvent): void => {
    const step = ARROWS[event.key];
    if (step !== undefined) this.place = moved(this.place, step);
    else if (event.key === "+" || event.key === "=") this.#zoom(2);
    else if (event.key === "-") this.#zoom(0.5);
    else return;
    event.preventDefault();
  };

  readonly #zoomHere = (event: MouseEvent): void => {
    const at = this.#pointOf(event);
    this.#drag({ times: 2, from: at, to: at });
  };

  /** Reserves two-finger gestures for the picture; the browser would scroll. */
  readonly #touch = (event: TouchEvent): void => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  };

  readonly #grab = (event: PointerEvent): void => {
    if (this.isMeasuring) {
      const at = this.#millimetres(event);
      const [from, to] = this.ruler;
      // The first press starts a line, the second ends it.
      if (at !== null) this.ruler = from === undefined || (to !== undefined && !this.#isRuling) ? [at, at] : [from, at];
      this.#isRuling = !this.#isRuling;
      return;
    }
    this.#held.set(event.pointerId, this.#pointOf(event));
    this.#canvas.setPointerCapture(event.pointerId);
  };

  readonly #pull = (event: PointerEvent): void => {
    const [from] = this.ruler;
    const at = this.#isRuling && from !== undefined ? this.#millimetres(event) : null;
    if (at !== null && from !== undefined) this.ruler = [from, at];
    if (!this.#held.has(event.pointerId)) return;
    const before = this.#grip();
    this.#held.set(event.pointerId, this.#pointOf(event));
    const after = this.#grip();
    const times = before.spread_px > 0 && after.spread_px > 0 ? after.spread_px / before.spread_px : 1;
    if (this.place.zoom > 1 || times !== 1) this.#drag({ times, from: before.middle, to: after.middle });
  };

  readonly #release = (event: PointerEvent): void => {
    this.#held.delete(event.pointerId);
  };

  #drag(drag: { times?: number; from: Point; to: Point }): void {
    const { mask, report } = this;
    if (mask === null || report === null) return;
    const { clientWidth, clientHeight } = this.#canvas;
    this.place = dragged(this.place, drag, [mask.width, mask.height], [clientWidth, clientHeight], pitchOf(report));
  }

  /** Centre of the pointers, and the distance of the first two; 0 for one. */
  #grip(): { middle: Point; spread_px: number } {
    const [[x, y] = [0, 0], other] = [...this.#held.values()];
    if (other === undefined) return { middle: [x, y], spread_px: 0 };
    const { clientWidth, clientHeight } = this.#canvas;
    const spread_px = Math.hypot((x - other[0]) * clientWidth, (y - other[1]) * clientHeight);
    return { middle: [(x + other[0]) / 2, (y + other[1]) / 2], spread_px };
  }

  #pointOf({ clientX, clientY }: MouseEvent): Point {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    return [(clientX - left) / width, (clientY - top) / height];
  }
}

/** Pixel height divided by pixel width. */
function pitchOf({ mask }: Layered): number {
  return mask.pitch_y_mm / mask.pitch_mm;
}

/** Position on the screen of a place, mm from the middle of the mask, whose rows start at the back. */
function screenOf([x_mm, y_mm]: Point, mask: Mask, { mask: { pitch_mm, pitch_y_mm } }: Layered, part: Rectangle, scale: readonly [number, number]): Point {
  return [(mask.width / 2 + x_mm / pitch_mm - part.x) * scale[0], (mask.height / 2 - y_mm / pitch_y_mm - part.y) * scale[1]];
}

/** Colours of pixels that are lit in one of two layers, little-endian: orange for new ones, blue for those of the layer below. */
const GROWN = 0xff1a9fff;
const GONE = 0xffb0602a;
/** Smallest difference of coverage that is a change. */
const CHANGE = 64;

/** @param beneath coverage by the layer below, for the changes; null for none */
function pictureOf({ width, height, values }: ReturnType<typeof coverage>, beneath: Uint8ClampedArray | null): HTMLCanvasElement | null {
  if (width === 0 || height === 0) return null;
  const picture = document.createElement("canvas");
  picture.width = width;
  picture.height = height;
  const image = new ImageData(width, height);
  // One word per pixel. Grey is the same in any byte order; alpha is the high byte, as browsers are little-endian.
  const words = new Uint32Array(image.data.buffer);
  for (let i = 0; i < values.length; i++) {
    const value = values[i] ?? 0;
    const grown = beneath === null ? 0 : value - (beneath[i] ?? 0);
    words[i] = grown > CHANGE ? GROWN : grown < -CHANGE ? GONE : 0xff000000 | (value * 0x010101);
  }
  picture.getContext("2d")?.putImageData(image, 0, 0);
  return picture;
}
