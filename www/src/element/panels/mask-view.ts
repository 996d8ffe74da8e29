/** Layer mask on a zoomable canvas, with a layer slider and a play button. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { Mask } from "../../api/index.js";
import type { Finding, Report } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { coverage, factorFor, wholeBytes, type Rectangle } from "../parts/bitmap.js";
import { css as cssColour, ofThickness } from "../../view/legend/palette.js";
import { styled } from "../parts/styled.js";
import { maskStyles } from "../styles/mask-styles.js";
import { shared } from "../styles/shared.js";
import { dragged, moved, WHOLE, windowOf, zoomed, type Point } from "../parts/window.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Minimum time between two layers during playback; the second value is for reduced motion. */
const FRAME_MS = 60;
const CALM_FRAME_MS = 400;

/** Distance that an arrow key moves the picture, as a fraction of the visible part. */
const STEP = 0.125;

/** Box around a finding: its colour, which no mask contains, and its margin in CSS pixels. */
const MARK_COLOUR = "#ff9f1a";
const MARK_ROOM_PX = 4;

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-STEP, 0],
  ArrowRight: [STEP, 0],
  ArrowUp: [0, -STEP],
  ArrowDown: [0, STEP],
};

/** The fields of a report that the panel reads; a print file provides them too. */
export interface Layered extends Pick<Report, "layers" | "z_mm" | "thickness_mm"> {
  mask: Pick<Report["mask"], "pitch_mm" | "pitch_y_mm">;
}

const PROPERTIES = {
  mask: given<Mask | null>(null),
  report: given<Layered | null>(null),
  limits: given<readonly [number, number]>([0, 0]),
  layer: given(0),
  /** The chosen finding, in its layers on each copy. */
  marks: given<readonly Pick<Finding, "bounds_mm" | "layers">[]>([]),
  language: given(languageOf()),
  place: own(WHOLE),
  playing: own(false),
};

export class CuspMask extends elementWith(PROPERTIES) {
  #resized: ResizeObserver | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Pointers on the picture, by id: one drags, two zoom. */
  readonly #held = new Map<number, Point>();
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
    return html`
      <div class="head"><h3>${words.title}</h3></div>
      <div class="well">
        <canvas
          class=${isZoomed ? "zoomed" : ""}
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
          ${isZoomed ? html`<span class="zoom figures">${words.zoom({ times: zoom })}</span>` : nothing}
          <button class="small" aria-label=${words.zoomOut} ?disabled=${!isZoomed} @click=${() => this.#zoom(0.5)}>−</button>
          <button class="small" aria-label=${words.zoomIn} @click=${() => this.#zoom(2)}>+</button>
        </div>
      </div>
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
      </dl>
    `;
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("mask") || changed.has("place") || changed.has("marks")) this.#paint();
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
    const picture = pictureOf(coverage(mask.bits, mask.width, whole, factor));
    if (picture !== null) {
      pen.imageSmoothingEnabled = factor * Math.max(...scale) < 1;
      const [x, y] = [(whole.x - part.x) * scale[0], (whole.y - part.y) * scale[1]];
      pen.drawImage(picture, x, y, picture.width * factor * scale[0], picture.height * factor * scale[1]);
    }
    this.#mark(pen, part, scale);
    // The layer painted, which may lag behind the slider.
    canvas.dataset["layer"] = String(mask.layer);
  }

  /** Draws boxes around the chosen finding if the painted layer contains it. */
  #mark(pen: CanvasRenderingContext2D, part: Rectangle, scale: readonly [number, number]): void {
    const { mask, report } = this;
    const marks = mask === null ? [] : this.marks.filter(({ layers: [first, last] }) => mask.layer >= first && mask.layer <= last);
    this.#canvas.toggleAttribute("data-marked", marks.length > 0);
    if (mask === null || report === null) return;
    const { pitch_mm, pitch_y_mm } = report.mask;
    // The model is in the middle of the mask, whose rows start at the back.
    const at = (x_mm: number, y_mm: number): Point => [
      (mask.width / 2 + x_mm / pitch_mm - part.x) * scale[0],
      (mask.height / 2 - y_mm / pitch_y_mm - part.y) * scale[1],
    ];
    const room = MARK_ROOM_PX * devicePixelRatio;
    for (const { bounds_mm: [[left, front], [right, back]] } of marks) {
      const [[x0, y0], [x1, y1]] = [at(left, back), at(right, front)];
      for (const [colour, width] of [["#000", 4], [MARK_COLOUR, 2]] as const) {
        pen.strokeStyle = colour;
        pen.lineWidth = width * devicePixelRatio;
        pen.strokeRect(x0 - room, y0 - room, x1 - x0 + 2 * room, y1 - y0 + 2 * room);
      }
    }
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
    this.#held.set(event.pointerId, this.#pointOf(event));
    this.#canvas.setPointerCapture(event.pointerId);
  };

  readonly #pull = (event: PointerEvent): void => {
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

function pictureOf({ width, height, values }: ReturnType<typeof coverage>): HTMLCanvasElement | null {
  if (width === 0 || height === 0) return null;
  const picture = document.createElement("canvas");
  picture.width = width;
  picture.height = height;
  const image = new ImageData(width, height);
  // One word per pixel. Grey is the same in any byte order; alpha is the high byte, as browsers are little-endian.
  const words = new Uint32Array(image.data.buffer);
  for (let i = 0; i < values.length; i++) words[i] = 0xff000000 | ((values[i] ?? 0) * 0x010101);
  picture.getContext("2d")?.putImageData(image, 0, 0);
  return picture;
}
