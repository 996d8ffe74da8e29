/**
 * `<cusp-print>`: the content of a print file from any slicer: its settings, faults and masks, and the printed model in 3-D. Import this
 * module lazily: it loads the reader, and the 3-D view with three.js.
 */
import { css, html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { isAbort, said, SlicerError } from "../api/error.js";
import type { Mask } from "../api/index.js";
import { define } from "../element/define.js";
import { CuspMask, type Layered } from "../element/panels/mask-view.js";
import { chosen } from "../element/parts/chosen.js";
import { progressStyles } from "../element/parts/progress.js";
import { viewTexts } from "../element/parts/view-texts.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { CuspView } from "../view/cusp-view.js";
import { elementWith, given, own } from "../view/properties.js";
import type { ViewTexts } from "../view/texts.js";
import type { KnownPrinter, Printer } from "../api/wire.js";
import { factsOf } from "./facts.js";
import { isCoded, openPrint, type Print, type ReadError } from "./open-print.js";
import { printerFor } from "./printer.js";
import { failureOf, findingOf, printTexts } from "./texts.js";
import type { PrintFileError } from "./wire.js";
import { shown } from "../api/visible.js";

type State =
  | { is: "reading"; done: number }
  | { is: "failed"; error: PrintFileError | ReadError }
  | { is: "open"; print: Print; report: Layered; limits: readonly [number, number] };

const PROPERTIES = {
  file: given<File | null>(null),
  /** Printers that files may name. */
  printers: given<readonly KnownPrinter[]>([]),
  language: given<Language>(languageOf()),
  state: own<State>({ is: "reading", done: 0 }),
  layer: own(0),
  mask: own<Mask | null>(null),
};

export class CuspPrint extends elementWith(PROPERTIES) {
  #life = new AbortController();
  #texts: { of: Language; words: ViewTexts } | null = null;
  /** The print whose mask is being fetched. A terminated worker never answers. */
  #fetching: State | null = null;

  static override styles = [
    theme,
    shared,
    progressStyles,
    css`
      header {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        justify-content: space-between;
        gap: 0.5rem 1rem;
        margin-bottom: 1rem;
      }
      h2 {
        font-size: 1.125rem;
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      /* Focused by the page alone, to be read out. */
      h2:focus {
        outline: none;
      }
      .buttons {
        display: flex;
        flex-wrap: wrap;
        gap: 0.5rem;
      }
      .cards {
        display: grid;
        gap: 1rem;
      }
      .card {
        min-width: 0;
      }
      .view {
        display: grid;
        min-height: 24rem;
        height: 100%;
      }
      .view {
        grid-template-rows: 1fr auto;
      }
      cusp-view {
        min-height: 22rem;
      }
      cusp-mask {
        height: auto;
      }
      @container (min-width: 56rem) {
        .cards {
          grid-template-columns: minmax(18rem, 2fr) 3fr;
        }
        .facts {
          grid-row: span 2;
        }
      }
      .facts dl {
        display: grid;
        grid-template-columns: auto 1fr;
        gap: 0.375rem 1rem;
        font-size: 0.9375rem;
      }
      dt {
        color: var(--cusp-quiet);
      }
      dd {
        overflow-wrap: anywhere;
      }
      figure {
        margin: 1rem 0 0;
      }
      figure canvas {
        display: block;
        max-width: 100%;
        max-height: 14rem;
        border-radius: 8px;
        background: #000;
      }
      figcaption {
        margin-top: 0.25rem;
      }
      .verdict {
        margin-bottom: 1rem;
        padding: 0.75rem 1rem;
        border-radius: 8px;
        background: var(--cusp-note-wash);
      }
      .verdict.bad {
        background: var(--cusp-bad-wash);
      }
      .verdict strong {
        color: var(--cusp-bad);
      }
      .verdict ul {
        margin: 0.25rem 0 0;
        padding-inline-start: 1.25rem;
      }
      .use {
        margin-bottom: 1rem;
      }
      .under {
        margin-top: 0.5rem;
      }
    `,
  ];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#end();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("file") && this.file !== null) void this.#read(this.file);
  }

  override render(): TemplateResult {
    const { state, file } = this;
    const words = printTexts(this.language);
    return html`<section aria-label=${words.region} aria-busy=${state.is === "reading"}>
      <header>
        <h2 tabindex="-1">${shown(file?.name ?? "")}</h2>
        <div class="buttons">
          <label class="button small">
            <input class="visually-hidden" type="file" @change=${this.#picked} />
            ${words.another}
          </label>
          <button class="small" @click=${this.#close}>${state.is === "reading" ? words.cancel : words.back}</button>
        </div>
      </header>
      ${state.is === "reading"
        ? html`<div class="card progress">
            <div>
              <div class="line"><span class="words">${words.reading({ name: shown(file?.name ?? "") })}</span></div>
              <progress aria-label=${words.reading({ name: shown(file?.name ?? "") })} max="1" .value=${state.done}></progress>
            </div>
          </div>`
        : state.is === "failed"
          ? html`<div class="card verdict bad" role="alert"><p>${failureOf(state.error, this.language)}</p></div>`
          : this.#cards(state)}
    </section>`;
  }

  override updated(changed: PropertyValues<this>): void {
    const { state } = this;
    if (changed.has("file")) this.renderRoot.querySelector("h2")?.focus({ preventScroll: true });
    const canvas = this.renderRoot.querySelector<HTMLCanvasElement>("figure canvas");
    if (changed.has("state") && state.is === "open" && state.print.preview !== null && canvas !== null) {
      const { width, height, rgba } = state.print.preview;
      canvas.getContext("2d")?.putImageData(new ImageData(rgba, width, height), 0, 0);
    }
  }

  #cards({ print, report, limits }: State & { is: "open" }): TemplateResult {
    const { language, layer, mask } = this;
    const words = printTexts(language);
    const { inspection, preview } = print;
    const hasLayers = report.layers > 0;
    return html`<div class="cards">
      <div class="card facts">
        ${this.#verdict(print)} ${this.#printer(print)}
        <dl class="figures">
          ${factsOf(inspection, language).map(([name, text]) => html`<dt>${name}</dt><dd>${text}</dd>`)}
        </dl>
        ${preview === null
          ? nothing
          : html`<figure>
              <canvas width=${preview.width} height=${preview.height} role="img" aria-label=${words.preview}></canvas>
              <figcaption class="quiet">${words.preview}</figcaption>
            </figure>`}
      </div>
      <div class="card view">
        <cusp-view
          .positions=${print.surface}
          .z_mm=${report.z_mm}
          .thickness_mm=${report.thickness_mm}
          .limits=${limits}
          .layer=${hasLayers ? layer : null}
          .texts=${this.#words()}
          @cusp-layer=${this.#go}
        ></cusp-view>
        <p class="quiet under">${print.surface.length === 0 ? words.noSurface : words.rough}</p>
      </div>
      ${hasLayers
        ? html`<div class="card">
            <cusp-mask
              .mask=${mask === null || mask.bits.length === 0 ? null : mask}
              .report=${report}
              .limits=${limits}
              .layer=${layer}
              .language=${language}
              @cusp-layer=${this.#go}
            ></cusp-mask>
            <p class="quiet under figures" aria-live="polite">${this.#layerWords(print)}</p>
          </div>`
        : nothing}
    </div>`;
  }

  #verdict({ inspection }: Print): TemplateResult {
    const words = printTexts(this.language);
    const { warnings } = inspection;
    if (warnings.length === 0) return html`<p class="verdict">${words.whole}</p>`;
    return html`<div class="verdict bad">
      <strong>${words.warnings({ count: warnings.length })}</strong>
      <ul>
        ${warnings.map((warning) => html`<li>${findingOf(warning, this.language)}</li>`)}
      </ul>
    </div>`;
  }

  /** Button that chooses the printer of the file for what is sliced from now on. */
  #printer({ inspection }: Print): TemplateResult | typeof nothing {
    const printer = printerFor(inspection, this.printers);
    if (printer === null) return nothing;
    const use = (): void => void this.dispatchEvent(new CustomEvent<string | Printer>("cusp-printer", { detail: printer }));
    return html`<button class="small use" @click=${use}>${printTexts(this.language).use}</button>`;
  }

  /** Exposure and lit pixels of the selected layer. */
  #layerWords({ inspection }: Print): string {
    const words = printTexts(this.language);
    const { format } = this.language;
    const values = inspection.layer_values[this.layer];
    if (values === undefined) return "";
    const exposure_s = values.exposure_s ?? inspection.exposure_s;
    const layer = this.layer + 1;
    const lit = values.lit_pixels === null ? words.damaged : words.pixelsLit({ pixels: values.lit_pixels });
    if (exposure_s === null) return words.layer.bare({ layer, lit });
    return words.layer.exposed({ layer, exposure: words.exposed({ exposure: format.measure(exposure_s, "s") }), lit });
  }

  async #read(file: File): Promise<void> {
    this.#end();
    const life = (this.#life = new AbortController());
    this.mask = null;
    this.state = { is: "reading", done: 0 };
    try {
      const print = await openPrint(file, life.signal, (done) => {
        if (!life.signal.aborted) this.state = { is: "reading", done };
      });
      const layers = print.inspection.layer_values;
      const thickness_mm = layers.map((layer) => layer.thickness_mm);
      const [pitch_mm, pitch_y_mm] = print.pixel_mm;
      const report = {
        layers: layers.length,
        // Boundaries from the plate, on which the first layer lies.
        z_mm: [(layers[0]?.z_mm ?? 0) - (thickness_mm[0] ?? 0), ...layers.map((layer) => layer.z_mm)],
        thickness_mm,
        mask: { pitch_mm, pitch_y_mm },
        exposure_s: layers.map(({ exposure_s }) => exposure_s ?? print.inspection.exposure_s ?? Number.NaN),
      };
      this.layer = Math.floor(layers.length / 2);
      this.state = { is: "open", print, report, limits: print.inspection.thickness_range_mm ?? [0, 0] };
      void this.#fetch();
    } catch (error) {
      if (isAbort(error, life.signal)) return;
      if (error instanceof SlicerError) return void this.dispatchEvent(new CustomEvent("cusp-missing"));
      const described: PrintFileError | ReadError = isCoded(error) ? error : { code: "crash", detail: { system: said(error) } };
      this.state = { is: "failed", error: described };
      // Not a print file: the host may try something else.
      if (["unknown-kind", "unknown-zip", "model"].includes(described.code)) this.dispatchEvent(new CustomEvent("cusp-unknown"));
    }
  }

  /** Fetches the mask of the selected layer, one at a time: while the slider is dragged, only the newest matters. */
  async #fetch(): Promise<void> {
    const { state } = this;
    if (this.#fetching === state || state.is !== "open" || state.report.layers === 0) return;
    this.#fetching = state;
    while (this.state === state && this.mask?.layer !== this.layer) {
      const { layer } = this;
      const mask = await state.print.mask(layer);
      if (this.state === state) this.mask = mask ?? { layer, width: 0, height: 0, bits: new Uint8Array(0) };
    }
    if (this.#fetching === state) this.#fetching = null;
  }

  #end(): void {
    this.#life.abort(new DOMException("another file was opened", "AbortError"));
    if (this.state.is === "open") this.state.print.close();
  }

  #words(): ViewTexts {
    if (this.#texts?.of !== this.language) this.#texts = { of: this.language, words: viewTexts(this.language) };
    return this.#texts.words;
  }

  readonly #go = ({ detail }: CustomEvent<number>): void => {
    if (this.state.is !== "open") return;
    this.layer = Math.min(Math.max(0, Math.round(detail)), this.state.report.layers - 1);
    void this.#fetch();
  };

  readonly #close = (): void => {
    this.dispatchEvent(new CustomEvent("cusp-close"));
  };

  readonly #picked = (event: Event): void => {
    const files = chosen(event);
    if (files.length > 0) this.dispatchEvent(new CustomEvent<File[]>("cusp-files", { detail: files }));
  };
}

/** Registers the element and the elements that it contains. */
export function definePrint(): void {
  define("cusp-view", CuspView);
  define("cusp-mask", CuspMask);
  define("cusp-print", CuspPrint);
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-print": CuspPrint;
  }
}
