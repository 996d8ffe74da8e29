/** A layer's mask on a canvas, with the range input that goes through the layers. */
import { css, html, LitElement, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { coverage, factorFor } from "./bitmap.js";
import { css as cssColour, ofThickness } from "./colour.js";
import * as format from "../texts/format.js";
import type { Mask } from "./session.js";
import { shared } from "./styles.js";
import type { Report } from "../api/wire.js";

/** A canvas larger than this costs memory and shows nothing more. */
const CANVAS_LIMIT = 1024;

export class CuspMask extends LitElement {
  static override properties = {
    mask: { attribute: false },
    report: { attribute: false },
    limits: { attribute: false },
    layer: { type: Number },
  };

  declare mask: Mask | null;
  declare report: Report | null;
  declare limits: readonly [number, number];
  declare layer: number;

  constructor() {
    super();
    this.mask = null;
    this.report = null;
    this.limits = [0, 0];
    this.layer = 0;
  }

  static override styles = [
    shared,
    css`
      :host {
        display: flex;
        flex-direction: column;
        min-width: 0;
        height: 100%;
      }
      .well {
        flex: 1;
        display: grid;
        place-items: center;
        min-height: 18rem;
        padding: 0.75rem;
        border-radius: 8px;
        background: #000;
      }
      canvas {
        display: block;
        max-width: 100%;
        max-height: 26rem;
        object-fit: contain;
      }
      .scrub {
        display: grid;
        grid-template-columns: auto 1fr auto;
        align-items: center;
        gap: 0.5rem;
        margin-top: 0.75rem;
      }
      .scrub button {
        min-width: 2.75rem;
        padding: 0;
        font-size: 1.25rem;
      }
      input {
        width: 100%;
        height: 2.75rem;
        margin: 0;
        accent-color: var(--cusp-accent);
      }
      dl {
        display: flex;
        flex-wrap: wrap;
        justify-content: space-between;
        gap: 0.25rem 1rem;
        margin-top: 0.5rem;
      }
      dt {
        color: var(--cusp-quiet);
        font-size: 0.8125rem;
      }
      dd {
        font-weight: 550;
        white-space: nowrap;
      }
      @media (max-width: 420px) {
        dl {
          font-size: 0.875rem;
        }
      }
      .swatch {
        display: inline-block;
        width: 0.75em;
        height: 0.75em;
        margin-right: 0.375em;
        border-radius: 2px;
      }
    `,
  ];

  override render(): TemplateResult {
    const { report, layer } = this;
    const layers = report?.layers ?? 1;
    const z = report?.z_mm[layer] ?? 0;
    const thickness = report?.thickness_mm[layer] ?? 0;
    const said = `Layer ${format.count(layer + 1)} of ${format.count(layers)}, at ${format.height(z)}, ${format.height(thickness)} thick`;
    return html`
      <div class="head"><h3>Mask of a layer</h3></div>
      <div class="well"><canvas role="img" aria-label=${`Mask. ${said}`}></canvas></div>
      <div class="scrub">
        <button aria-label="Layer below" ?disabled=${layer <= 0} @click=${() => this.#go(layer - 1)}>−</button>
        <input
          type="range"
          aria-label="Layer"
          aria-valuetext=${said}
          min="1"
          max=${layers}
          step="1"
          .value=${live(String(layer + 1))}
          @input=${(event: Event) => this.#go(Number((event.target as HTMLInputElement).value) - 1)}
        />
        <button aria-label="Layer above" ?disabled=${layer >= layers - 1} @click=${() => this.#go(layer + 1)}>+</button>
      </div>
      <dl class="figures">
        <div>
          <dt>Layer</dt>
          <dd>${format.count(layer + 1)} / ${format.count(layers)}</dd>
        </div>
        <div>
          <dt>Height</dt>
          <dd>${format.height(z)}</dd>
        </div>
        <div>
          <dt>Thickness</dt>
          <dd>
            <span class="swatch" style="background:${cssColour(ofThickness(thickness, this.limits))}"></span
            >${format.height(thickness)}
          </dd>
        </div>
      </dl>
    `;
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("mask")) this.#paint();
  }

  #paint(): void {
    const canvas = this.renderRoot.querySelector("canvas");
    const { mask } = this;
    if (canvas === null) return;
    if (mask === null) {
      canvas.getContext("2d")?.clearRect(0, 0, canvas.width, canvas.height);
      canvas.removeAttribute("data-layer");
      return;
    }
    const factor = factorFor(mask.width, mask.height, CANVAS_LIMIT);
    const { width, height, values } = coverage(mask.bits, mask.width, mask.height, factor);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const image = new ImageData(width, height);
    // One word a pixel: opaque grey reads the same in any byte order but for the alpha, and browsers are little-endian.
    const words = new Uint32Array(image.data.buffer);
    for (let i = 0; i < values.length; i++) words[i] = 0xff000000 | ((values[i] ?? 0) * 0x010101);
    canvas.getContext("2d")?.putImageData(image, 0, 0);
    // Says which layer the picture is of, which may lag behind the slider.
    canvas.dataset["layer"] = String(mask.layer);
  }

  #go(layer: number): void {
    this.dispatchEvent(new CustomEvent<number>("cusp-layer", { detail: layer }));
  }
}

customElements.define("cusp-mask", CuspMask);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-mask": CuspMask;
  }
}
