/** Scores of all directions on a Gaussian sphere, seen from the front and the back, turning with the neighbouring view. */
import { css, html, nothing, svg, type PropertyValues, type SVGTemplateResult, type TemplateResult } from "lit";
import type { Found } from "../../api/index.js";
import type { Candidate } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { orientationTexts } from "../../texts/orientation.js";
import { drawSphere, Nearest, placeOf, seenAt, type Place, type Side } from "../../view/gaussian.js";
import { colourAt, type Rgb } from "../../view/legend/palette.js";
import type { Rotation, Triple } from "../../view/scene/pose.js";
import { back, combined, FIRST_LOOK, lookFrom, turn } from "../../view/scene/turn.js";
import { stepped, type Way } from "../parts/sphere-steps.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Maximum device pixel ratio to draw at; finer pixels are not visible. */
const DENSITY_LIMIT = 2;

/** The grey of excluded directions, outside the colour scale; visible on light and dark cards. */
const EXCLUDED: Rgb = [138, 143, 152];

/** Hit radius of a mark, in radii of the sphere. */
const MARK_REACH = 0.1;

/** The candidate whose metrics are shown. */
export interface Looked {
  readonly candidate: Candidate;
  /** True if it stays after the pointer leaves. */
  readonly isChosen: boolean;
}

const SIDES: readonly Side[] = ["front", "back"];

const WAYS: Readonly<Record<string, Way>> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };

/** Initial camera, also used without a view. */
const FIRST_CAMERA = lookFrom(FIRST_LOOK);

/** Lowest and highest energy of the candidates; null if none is rated. */
export function energyRange(candidates: readonly (Candidate | null)[]): readonly [number, number] | null {
  const energies = candidates.flatMap((candidate) => candidate?.energy ?? []);
  return energies.length === 0 ? null : [Math.min(...energies), Math.max(...energies)];
}

/** The colour of each candidate: warm for the highest energy, cold for the lowest, grey if excluded; null if unknown. */
export function coloursOf(candidates: readonly (Candidate | null)[]): (Rgb | null)[] {
  const [least, greatest] = energyRange(candidates) ?? [0, 0];
  const span = greatest - least;
  return candidates.map((candidate) => {
    if (candidate === null) return null;
    if (candidate.excluded !== null) return EXCLUDED;
    if (candidate.energy === null) return null;
    return colourAt(span > 0 ? (greatest - candidate.energy) / span : 1);
  });
}

const PROPERTIES = {
  found: given<Found | null>(null),
  best: given<readonly Candidate[]>([]),
  /** The rotation of the model. */
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** Camera rotation of the neighbouring view; null without a view. */
  camera: given<Rotation | null>(null),
  language: given(languageOf()),
  /** The candidate under the pointer. */
  hovered: own<Candidate | null>(null),
  /** The candidate chosen by keyboard, or by the first tap. */
  chosen: own<Candidate | null>(null),
};

export class CuspSphere extends elementWith(PROPERTIES) {
  /** True if the last press was a touch: not all browsers report that in the click event. */
  #isTouched = false;
  #nearest: { of: Float64Array; nearest: Nearest } | null = null;
  readonly #resized = new ResizeObserver(() => this.#draw());

  static override styles = [
    shared,
    css`
      :host {
        display: block;
        min-width: 0;
        direction: ltr;
      }
      .pair {
        display: grid;
        grid-template-columns: repeat(2, minmax(0, 13rem));
        justify-content: center;
        gap: 0.75rem;
        border-radius: 8px;
      }
      figure {
        margin: 0;
        text-align: center;
      }
      .disc {
        position: relative;
        aspect-ratio: 1;
        border-radius: 50%;
        background: var(--cusp-line);
        cursor: pointer;
        touch-action: manipulation;
      }
      canvas,
      svg {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
      }
      canvas {
        opacity: var(--cusp-faded, 1);
      }
      svg {
        overflow: visible;
        pointer-events: none;
      }
      circle,
      path {
        fill: none;
        stroke: var(--cusp-text);
        stroke-width: 2;
      }
      .halo {
        stroke: var(--cusp-card);
        stroke-width: 5;
      }
      figcaption {
        margin-top: 0.5rem;
      }
      .best circle {
        fill: var(--cusp-card);
      }
      .best text {
        fill: var(--cusp-text);
        font-size: 11px;
        font-weight: 650;
        text-anchor: middle;
        dominant-baseline: central;
      }
      /* The colours of the discs are data; the marks above them are not. */
      @media (forced-colors: active) {
        canvas {
          forced-color-adjust: none;
        }
        .disc {
          border: 1px solid CanvasText;
        }
        circle,
        path {
          stroke: CanvasText;
        }
        .halo {
          stroke: Canvas;
        }
        .best circle {
          fill: Canvas;
        }
        .best text {
          fill: CanvasText;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.hasUpdated) this.#resized.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#resized.disconnect();
  }

  override firstUpdated(): void {
    this.#resized.observe(this);
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("found")) return;
    // Updates the hovered and the chosen candidate with their newest metrics.
    const newest = (it: Candidate | null): Candidate | null =>
      it === null ? null : (this.found?.candidates[this.#indexAt(it.direction) ?? -1] ?? null);
    this.hovered = newest(this.hovered);
    this.chosen = newest(this.chosen);
  }

  override updated(changed: PropertyValues<this>): void {
    if ((["found", "rotation", "camera"] as const).some((name) => changed.has(name))) this.#draw();
    if (changed.has("hovered") || changed.has("chosen")) {
      const candidate = this.hovered ?? this.chosen;
      const detail: Looked | null = candidate === null ? null : { candidate, isChosen: candidate === this.chosen };
      this.dispatchEvent(new CustomEvent<Looked | null>("cusp-look", { detail }));
    }
  }

  override render(): TemplateResult {
    const words = orientationTexts(this.language);
    return html`<div
      class="pair"
      tabindex="0"
      role="application"
      aria-label=${words.sphere}
      aria-roledescription=${words.kind}
      aria-describedby="keys"
      @keydown=${this.#key}
    >
      ${SIDES.map(
        (side) => html`<figure>
          <div
            class="disc"
            @pointerdown=${({ pointerType }: PointerEvent) => (this.#isTouched = pointerType === "touch")}
            @pointermove=${(event: PointerEvent) => this.#hover(event, side)}
            @pointerleave=${() => (this.hovered = null)}
            @click=${(event: MouseEvent) => this.#click(event, side)}
          >
            <canvas></canvas>
            <svg viewBox="-100 -100 200 200" aria-hidden="true">${this.#marks(side)}</svg>
          </div>
          <figcaption class="quiet">${words[side]}</figcaption>
        </figure>`,
      )}
      <p class="visually-hidden" id="keys">${words.keys}</p>
    </div>`;
  }

  /** Rotation from the file's frame to the viewer's: right, up, towards the viewer. */
  get #facing(): Rotation {
    return combined(this.rotation, back(this.camera ?? FIRST_CAMERA));
  }

  #marks(side: Side): SVGTemplateResult[] {
    const facing = this.#facing;
    const at = (seen: Triple, draw: (x: number, y: number) => SVGTemplateResult): SVGTemplateResult | typeof nothing => {
      const found = placeOf(seen);
      return found.side === side ? draw(100 * found.place[0], -100 * found.place[1]) : nothing;
    };
    const ring = (x: number, y: number, radius: number): SVGTemplateResult =>
      svg`<circle class="halo" cx=${x} cy=${y} r=${radius} /><circle cx=${x} cy=${y} r=${radius} />`;
    const up = at(turn(back(this.camera ?? FIRST_CAMERA), [0, 0, 1]), (x, y) => {
      // Longer than the mark of a best candidate, which may coincide.
      const cross = `M${x - 14} ${y}h28M${x} ${y - 14}v28`;
      return svg`<g class="up"><path class="halo" d=${cross} /><path d=${cross} /></g>`;
    });
    const best = this.best.map(({ direction }, i) =>
      at(turn(facing, direction), (x, y) => svg`<g class="best"><circle cx=${x} cy=${y} r="8" /><text x=${x} y=${y}>${i + 1}</text></g>`),
    );
    const looked = this.hovered ?? this.chosen;
    const ringed = looked === null ? nothing : at(turn(facing, looked.direction), (x, y) => ring(x, y, 11));
    return [svg`${up}${best}${ringed}`];
  }

  #directions(): Nearest | null {
    const directions = this.found?.directions;
    if (directions === undefined || directions.length === 0) return null;
    if (this.#nearest?.of !== directions) this.#nearest = { of: directions, nearest: new Nearest(directions) };
    return this.#nearest.nearest;
  }

  #indexAt(direction: Triple): number | null {
    return this.#directions()?.at(...direction) ?? null;
  }

  #draw(): void {
    const nearest = this.#directions();
    const colours = coloursOf(this.found?.candidates ?? []);
    const facing = this.#facing;
    for (const [i, canvas] of this.renderRoot.querySelectorAll("canvas").entries()) {
      const side_px = Math.round(canvas.clientWidth * Math.min(devicePixelRatio, DENSITY_LIMIT));
      const pen = canvas.getContext("2d");
      if (side_px === 0 || pen === null) continue;
      if (canvas.width !== side_px) canvas.width = canvas.height = side_px;
      const picture = pen.createImageData(side_px, side_px);
      if (nearest !== null) drawSphere(picture.data, side_px, SIDES[i] ?? "front", facing, nearest, colours);
      pen.putImageData(picture, 0, 0);
    }
  }

  /** Candidate at the pointer: a best one if near its mark; null outside the sphere. */
  #at({ currentTarget, clientX, clientY }: MouseEvent, side: Side): Candidate | null {
    const { left, top, width } = (currentTarget as HTMLElement).getBoundingClientRect();
    const place: Place = [(2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / width];
    const seen = seenAt(place, side);
    if (seen === null) return null;
    const facing = this.#facing;
    const meant = this.best.find(({ direction }) => {
      const found = placeOf(turn(facing, direction));
      return found.side === side && Math.hypot(found.place[0] - place[0], found.place[1] - place[1]) < MARK_REACH;
    });
    return meant ?? this.found?.candidates[this.#indexAt(turn(back(facing), seen)) ?? -1] ?? null;
  }

  #hover(event: PointerEvent, side: Side): void {
    if (event.pointerType !== "touch") this.hovered = this.#at(event, side);
  }

  /** A touch cannot hover: the first tap shows the metrics, and a second one on the same candidate applies it. */
  #click(event: MouseEvent, side: Side): void {
    const candidate = this.#at(event, side);
    if (this.#isTouched && candidate !== this.chosen) this.chosen = candidate;
    else this.#orient(candidate);
  }

  #orient(candidate: Candidate | null): void {
    if (candidate === null || candidate.excluded !== null) return;
    this.dispatchEvent(new CustomEvent<Candidate>("cusp-orient", { detail: candidate }));
  }

  readonly #key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const way = WAYS[event.key];
    if (event.key === "Enter" || event.key === " ") this.#orient(this.chosen);
    else if (way === undefined) return;
    else this.#step(way);
    event.preventDefault();
  };

  #step(way: Way): void {
    const nearest = this.#directions();
    if (nearest === null) return;
    const facing = this.#facing;
    const up = turn(back(this.camera ?? FIRST_CAMERA), [0, 0, 1]);
    const from = this.chosen === null ? up : turn(facing, this.chosen.direction);
    const indexOf = (seen: Triple): number => nearest.at(...turn(back(facing), seen));
    const index = this.chosen === null ? indexOf(from) : stepped(from, way, indexOf);
    this.chosen = this.found?.candidates[index] ?? this.chosen;
  }
}
