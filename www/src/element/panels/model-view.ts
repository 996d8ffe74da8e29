/** The 3-D view of the model and its tools. The view itself, and three.js with it, is fetched when first shown. */
import { css, html, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { Model, Slicer } from "../../api/index.js";
import type { Printer } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import type { Inset } from "../../view/scene/cameras.js";
import type { Look } from "../../view/scene/model.js";
import type { PaletteName } from "../../view/legend/palette.js";
import type { BuildVolume } from "../../view/scene/plate.js";
import type { Rotation } from "../../view/scene/pose.js";
import { heightOf } from "../../view/scene/turn.js";
import { BRUSH, rebased } from "../../view/paint/brush.js";
import type { CuspView } from "../../view/cusp-view.js";
import type { PaintDetail, RotateDetail } from "../../view/events.js";
import type { Tool } from "../../view/scene/keys.js";
import type { ViewTexts } from "../../view/texts.js";
import { viewTexts } from "../parts/view-texts.js";
import type { Painted } from "../events.js";
import { define } from "../define.js";
import { partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import { paintStyles, paintTools, type Colours } from "./paint-tools.js";
import type { PlotPlace } from "./profile-chart.js";
import type { Shown } from "../state/result.js";
import { DEFAULT_SETTINGS } from "../state/settings.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Room around the model without a chart beside it. */
const ALONE: Inset = { top_px: 12, bottom_px: 12 };
/** Initial size of the brush, as a fraction of the model's longest side. */
const BRUSH_PART = 0.2;
const TOOLS: readonly Tool[] = ["turn", "rotate", "flat", "paint"];

export interface Scaled {
  readonly height_mm: number;
  readonly rotation: Rotation;
}

const PROPERTIES = {
  slicer: given<Slicer | null>(null),
  /** A different model has its positions fetched. */
  model: given<Model | null>(null),
  shown: given<Shown | null>(null),
  layer: given(0),
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** The height that the model is scaled to, and the pose in which it has that height; null for the file's own size. */
  scaled: given<Scaled | null>(null, (a: unknown, b: unknown) => JSON.stringify(a) !== JSON.stringify(b)),
  printer: given<Printer | null>(null),
  language: given(languageOf()),
  /** The position and heights of the chart beside it; null without a chart. */
  plot: given<PlotPlace | null>(null),
  inset: own(ALONE),
  positions: own<Float32Array | null>(null),
  /** Whether the view has been fetched. */
  isThere: own(false),
  /** Whether it could not be fetched. */
  isMissing: own(false),
  tool: own<Tool>("turn"),
  look: own<Look>("thickness"),
  palette: own<PaletteName>("classic"),
  /** Whether to align heights with the chart, if that is beside the view. */
  aligned: own(true),
  settings: given(DEFAULT_SETTINGS),
  /** How much each facet matters; null: all equally. */
  weights: given<Float32Array | null>(null),
  /** How much each facet stands out; null until it is needed. */
  saliency: own<Float32Array | null>(null),
  isFinding: own(false),
  brush: own(BRUSH),
  colours: own<Colours>("product"),
  canUndo: own(false),
  canRedo: own(false),
};

export class CuspModel extends elementWith(PROPERTIES) {
  /** The factor from the file's lengths to those of the model. */
  #scale = 1;
  #texts: { of: Language; words: ViewTexts } | null = null;
  #asked: Model | null = null;
  readonly #resized = new ResizeObserver(() => this.requestUpdate());

  static override styles = [
    shared,
    paintStyles,
    partStyles,
    css`
      :host {
        display: flex;
        flex-direction: column;
        min-width: 0;
        height: 100%;
      }
      .view {
        flex: 1;
        display: grid;
        min-height: 28rem;
      }
      .tools {
        display: flex;
        flex-wrap: wrap;
        gap: 0.375rem;
        margin-top: 0.75rem;
      }
      [aria-pressed="true"] {
        border-color: transparent;
        background: var(--cusp-accent);
        color: var(--cusp-on-accent);
      }
      [aria-pressed="true"]:hover:not(:disabled) {
        background: var(--cusp-accent-hover);
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
  }

  override firstUpdated(): void {
    void this.#load();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("model") && this.model !== this.#asked) void this.#fetch();
    if (changed.has("positions") || changed.has("scaled")) this.#fit();
    const shows = this.tool === "paint" && (this.colours === "saliency" || this.#counts);
    if (shows && this.positions !== null && this.saliency === null && !this.isFinding) void this.#find();
  }

  override updated(): void {
    // The position of the view is known only after layout.
    const inset = this.#beside();
    const { top_px, bottom_px } = this.inset;
    if (inset.top_px !== top_px || inset.bottom_px !== bottom_px) this.inset = inset;
  }

  override render(): TemplateResult {
    const { shown, language, tool } = this;
    const canAlign = this.inset !== ALONE;
    const isPainting = tool === "paint";
    // An aligned view shows the model from the side only, so its top could not be painted.
    const isBeside = canAlign && this.aligned && !isPainting;
    const showsHeat = isPainting && this.colours !== "layers";
    const heat = this.colours === "layers" ? "paint" : this.colours;
    const { texts } = language;
    const words = texts.view;
    const isTurned = this.rotation.some((part, i) => part !== (i === 3 ? 1 : 0));
    const isMeasured = this.look === "distance";
    const isPrinted = this.look === "printed" || isMeasured;
    const toggle = (name: string, isOn: boolean, act: () => void): TemplateResult =>
      html`<button class="small" aria-pressed=${isOn ? "true" : "false"} @click=${act}>${name}</button>`;
    return html`
      <div class="head"><h3>${words.title}</h3></div>
      <div class="view">
        ${this.isThere
          ? html`<cusp-view
              .positions=${this.positions}
              .rotation=${this.rotation}
              .scale=${this.#scale}
              .z_mm=${shown?.z_mm ?? []}
              .thickness_mm=${shown?.thickness_mm ?? []}
              .limits=${shown?.limits ?? [0, 0]}
              .layer=${shown === null || showsHeat ? null : this.layer}
              .plate=${volumeOf(this.printer)}
              .look=${showsHeat ? "weights" : isPainting ? "thickness" : this.look}
              .weights=${this.weights}
              .saliency=${heat === "saliency" || this.#counts ? this.saliency : null}
              .heat=${heat}
              .least=${Number(this.settings.weightMin)}
              .brush=${this.brush}
              @cusp-paint=${this.#painted}
              .palette=${this.palette}
              .tool=${tool}
              .aligned=${isBeside}
              .showsLegend=${!isBeside}
              .heights_mm=${isBeside ? (this.plot?.heights_mm ?? null) : null}
              .inset=${isBeside ? this.inset : ALONE}
              .texts=${this.#words()}
              @cusp-rotate=${(event: CustomEvent<RotateDetail>) => this.#tell(event)}
              @cusp-layer=${(event: CustomEvent<number>) => this.#tell(event)}
              @cusp-camera=${(event: CustomEvent<Rotation>) => this.#tell(event)}
            ></cusp-view>`
          : this.isMissing
            ? partFailure(language, () => void this.#load())
            : nothing}
      </div>
      <div class="tools" role="group" aria-label=${words.title}>
        ${TOOLS.map((it) => toggle(words.tools[it], tool === it, () => (this.tool = it)))}
        ${toggle(words.printed, isPrinted, () => (this.look = isPrinted ? "thickness" : "printed"))}
        ${isPrinted ? toggle(words.measured, isMeasured, () => (this.look = isMeasured ? "printed" : "distance")) : nothing}
        ${toggle(words.safe, this.palette === "safe", this.#otherPalette)}
        ${!canAlign || isPainting ? nothing : toggle(words.aligned, this.aligned, () => (this.aligned = !this.aligned))}
        ${isTurned ? html`<button class="small" @click=${this.#upright}>${words.upright}</button>` : nothing}
      </div>
      ${isPainting ? this.#paintTools() : nothing}
    `;
  }

  async #load(): Promise<void> {
    this.isMissing = false;
    try {
      const { CuspView } = await import("../../view/cusp-view.js");
      define("cusp-view", CuspView);
      this.isThere = true;
    } catch (error) {
      this.isMissing = true;
      tellPartFailed(this, "view", error);
    }
  }

  readonly #otherPalette = (): void => {
    this.palette = this.palette === "safe" ? "classic" : "safe";
    this.#say<PaletteName>("cusp-palette", this.palette);
  };

  /** Whether saliency counts in the plan. */
  get #counts(): boolean {
    return this.settings.saliency === "on";
  }

  #paintTools(): TemplateResult {
    const { brush, colours, settings, isFinding, canUndo, canRedo, language } = this;
    const view = (): CuspView | null => this.renderRoot.querySelector("cusp-view");
    const isPainted = this.weights !== null;
    const give = (weights: Float32Array | null): void => {
      this.canUndo = true;
      this.#say<Painted>("cusp-paint", { weights, final: true });
    };
    return paintTools({
      ...{ brush, colours, settings, isFinding, canUndo, canRedo, isPainted, language, most_mm: this.#reach },
      brushed: (change) => {
        const before = this.brush.base;
        this.brush = { ...this.brush, ...change };
        if (change.base === undefined) return;
        const weights = this.weights ?? new Float32Array((this.positions?.length ?? 0) / 9).fill(before);
        give(rebased(weights, before, change.base));
      },
      coloured: (colours) => (this.colours = colours),
      changed: (change) => this.#say("cusp-settings", change),
      undo: () => view()?.undo(),
      redo: () => view()?.redo(),
      clear: () => {
        this.brush = { ...this.brush, base: BRUSH.base };
        give(null);
      },
      open: (file) => this.#say("cusp-open-weights", file),
      save: () => this.#say("cusp-save-weights", null),
    });
  }

  #fit(): void {
    const { positions, scaled } = this;
    const own_mm = positions === null || scaled === null ? 0 : heightOf(positions, scaled.rotation);
    this.#scale = own_mm > 0 ? (scaled?.height_mm ?? own_mm) / own_mm : 1;
  }

  /** The model's longest side at its current scale, mm: the maximum size of the brush. */
  get #reach(): number {
    return this.#scale * Math.max(...(this.model?.info.size_mm ?? [1]));
  }

  readonly #painted = (event: CustomEvent<PaintDetail>): void => {
    ({ canUndo: this.canUndo, canRedo: this.canRedo } = event.detail);
    this.#tell(event);
  };

  /** Fetches the saliency of the model. */
  async #find(): Promise<void> {
    const { model, slicer } = this;
    if (slicer === null) return;
    this.isFinding = true;
    // Without saliency there is nothing to show; a broken worker is reported elsewhere.
    const saliency = await slicer.saliency().catch(() => new Float32Array(0));
    this.isFinding = false;
    if (this.model === model) this.saliency = saliency;
  }

  #say<Detail>(type: string, detail: Detail): void {
    this.dispatchEvent(new CustomEvent<Detail>(type, { detail }));
  }

  /** Room around the model that aligns heights with the chart, if the chart is beside the view and not above or below it. */
  #beside(): Inset {
    const view = this.renderRoot.querySelector("cusp-view")?.getBoundingClientRect();
    const plot = this.plot?.over.getBoundingClientRect();
    if (view === undefined || plot === undefined) return ALONE;
    const isBeside = plot.top >= view.top && plot.bottom <= view.bottom && plot.height > 0;
    return isBeside ? { top_px: plot.top - view.top, bottom_px: view.bottom - plot.bottom } : ALONE;
  }

  /** Cached per language: a new object would count as a change of the texts. */
  #words(): ViewTexts {
    if (this.#texts?.of !== this.language) this.#texts = { of: this.language, words: viewTexts(this.language) };
    return this.#texts.words;
  }

  /** Fires an event of the view again from here, since those do not bubble. */
  #tell<Detail>({ type, detail }: CustomEvent<Detail>): void {
    this.#say(type, detail);
  }

  readonly #upright = (): void => {
    this.#say<RotateDetail>("cusp-rotate", { rotation: [0, 0, 0, 1], final: true });
  };

  async #fetch(): Promise<void> {
    const { model, slicer } = this;
    this.#asked = model;
    this.positions = null;
    this.saliency = null;
    this.brush = BRUSH;
    this.canUndo = this.canRedo = false;
    if (model === null || slicer === null) return;
    // Without positions the view is empty; a broken worker is reported elsewhere.
    const positions = await slicer.positions().catch(() => null);
    if (this.#asked !== model) return;
    this.positions = positions;
    this.brush = { ...BRUSH, size_mm: BRUSH_PART * this.#reach };
  }
}

const volumes = new WeakMap<Printer, BuildVolume>();

function volumeOf(printer: Printer | null): BuildVolume | null {
  if (printer === null) return null;
  let volume = volumes.get(printer);
  if (volume === undefined) {
    const [width_mm, depth_mm, height_mm] = printer.volume_mm;
    volumes.set(printer, (volume = { width_mm, depth_mm, height_mm }));
  }
  return volume;
}
