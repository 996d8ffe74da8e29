/** The 3-D view of the model and its tools. The view itself, and three.js with it, is fetched when first shown. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { Model } from "../../api/index.js";
import type { ModelCalls } from "../state/selected.js";
import { FACTS, isFilament } from "../../api/facts.js";
import type { Printer } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import type { Mark } from "../../view/scene/marker.js";
import type { Look } from "../../view/scene/model.js";
import type { PaletteName } from "../../view/legend/palette.js";
import type { Rotation } from "../../view/scene/pose.js";
import { heightOf } from "../../view/scene/turn.js";
import type { Copy as Standing } from "../../view/scene/copies.js";
import type { MoveDetail } from "../../view/scene/moving.js";
import { BRUSH, rebased } from "../../view/paint/brush.js";
import type { CuspView } from "../../view/cusp-view.js";
import type { PaintDetail, PointDetail, RotateDetail } from "../../view/events.js";
import type { Tool } from "../../view/scene/keys.js";
import { places } from "../../view/scene/places.js";
import type { ViewTexts } from "../../view/texts.js";
import { volumeOf } from "../parts/build-volume.js";
import { PlateView, type Shapes } from "../parts/plate-view.js";
import { viewTexts } from "../parts/view-texts.js";
import type { Painted } from "../events.js";
import { define } from "../define.js";
import { fetched } from "../parts/fetched.js";
import { adopt, FetchedPanel, partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import type { Colours } from "./paint-tools.js";
import type { Edited, PointEditor } from "./point-tools.js";
import { barStyles, viewBar } from "./view-bar.js";
import type { PlotPlace } from "./profile-chart.js";
import type { Copy, Entry } from "../state/plate.js";
import type { Shown } from "../state/result.js";
import { DEFAULT_SETTINGS } from "../state/settings.js";
import { modelViewStyles } from "../styles/model-view-styles.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Few people paint, or place points. */
const paintCode = new FetchedPanel("paint", () => import("./paint-tools.js"));
const pointCode = new FetchedPanel("points", () => import("./point-tools.js"));

/** Initial size of the brush, as a fraction of the model's longest side. */
const BRUSH_PART = 0.2;

/** A view is shown after the plan, but at the latest so long after the model was read. */
const LATEST_MS = 700;

/** Fetches the view. */
export const fetchView = fetched(() => import("../../view/cusp-view.js"));

/** Always the same list: another one would count as a change. */
const NO_POINTS: CuspView["points"] = [];
const NO_COPIES: readonly Standing[] = [];

export interface Scaled {
  readonly height_mm: number;
  readonly rotation: Rotation;
}

const PROPERTIES = {
  slicer: given<ModelCalls | null>(null),
  /** A different model has its positions fetched. */
  model: given<Model | null>(null),
  /** The positions of the model, if they came with it. */
  corners: given<Float32Array | null>(null),
  /** True if the first plan of the model is being made. It is shown first: what the view does takes processors away from it. */
  isPlanning: given(false),
  shown: given<Shown | null>(null),
  layer: given(0),
  /** The finding to be shown, on each copy. */
  marks: given<readonly Mark[]>([]),
  /** Whether to show how thick the model is: what is thinner than this is marked, mm; null: not to. */
  walls_mm: given<number | null>(null),
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** The height that the model is scaled to, and the pose in which it has that height; null for the file's own size. */
  scaled: given<Scaled | null>(null, (a: unknown, b: unknown) => JSON.stringify(a) !== JSON.stringify(b)),
  printer: given<Printer | null>(null),
  /** The copies on the plate shown; none if the model is alone. */
  copies: given<readonly Copy[]>([]),
  /** The places of those that overlap others, or extend beyond the plate. */
  crowded: given<ReadonlySet<number>>(new Set()),
  /** Fetches the positions of a model of the plate. */
  shapes: given<Shapes | null>(null),
  language: given(languageOf()),
  /** The chart's plot and its heights, which the view aligns with where the plot is beside it; null without a chart. */
  plot: given<PlotPlace | null>(null),
  /** True if the plot is beside the view. */
  canAlign: own(false),
  positions: own<Float32Array | null>(null),
  /** True if the view has been fetched. */
  isThere: own(false),
  /** True if it could not be fetched. */
  isMissing: own(false),
  /** True if the browser has no WebGL. */
  isBroken: own(false),
  tool: own<Tool>("turn"),
  look: own<Look>("thickness"),
  palette: own<PaletteName>("classic"),
  /** Whether to align heights with the chart, if that is beside the view, and neither painting nor the printed look need another camera. */
  aligned: own(true),
  settings: given(DEFAULT_SETTINGS),
  /** The session whose points are placed by hand, with the settings above; null: they cannot be. */
  edited: given<Edited | null>(null),
  /** How much each facet matters; null: all equally. */
  weights: given<Float32Array | null>(null),
  /** How much each facet stands out; null until it is needed. */
  saliency: own<Float32Array | null>(null),
  isFinding: own(false),
  brush: own(BRUSH),
  colours: own<Colours>("product"),
  canUndo: own(false),
  canRedo: own(false),
  /** The copies as the view draws them. */
  standing: own<readonly Standing[]>([]),
  /** The copy that was pressed last, by its place. */
  pressed: own<number | null>(null),
};

export class CuspModel extends elementWith(PROPERTIES) {
  /** The factor from the file's lengths to those of the model. */
  #scale = 1;
  #texts: { of: Language; words: ViewTexts } | null = null;
  #asked: Model | null = null;
  /** Resolves when it is the view's turn: the first plan of the model is painted, or takes long. */
  #turn: Promise<unknown> = Promise.resolve();
  /** Ends that wait. */
  #next: (() => void) | null = null;
  #canAlign = false;
  #points: PointEditor | null = null;
  readonly #plate = new PlateView((copies) => (this.standing = copies));
  /** The model whose positions are shown. */
  #shownModel: Model | null = null;

  static override styles = [
    shared,
    partStyles,
    barStyles,
    modelViewStyles,
  ];

  override firstUpdated(): void {
    void this.#load();
  }

  override updated(): void {
    if (this.isPlanning || this.#next === null) return;
    const next = this.#next;
    this.#next = null;
    // The callbacks of a frame run before it is painted.
    requestAnimationFrame(() => setTimeout(next));
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("model") && this.model !== this.#asked) {
      if (this.isPlanning) this.#turn = new Promise<void>((resolve) => setTimeout((this.#next = resolve), LATEST_MS));
      void this.#fetch();
    }
    if (changed.has("positions") || changed.has("scaled")) this.#fit();
    if (changed.has("copies") || changed.has("crowded") || changed.has("positions")) {
      this.#plate.show(this.copies, this.crowded, this.shapes);
    }
    if ((this.tool === "move" || places(this.tool)) && !this.#offered.has(this.tool)) this.tool = "turn";
    const isPainting = this.tool === "paint";
    // Previews of turns and of strokes have a worker of their own, which reads the model now.
    if (changed.has("tool") && (isPainting || this.tool === "rotate")) this.slicer?.preview().catch(() => undefined);
    const needsSaliency = this.#counts ? isPainting || this.#showsHeat : isPainting && this.colours === "saliency";
    if (needsSaliency && this.positions !== null && this.saliency === null && !this.isFinding) void this.#find();
  }

  override render(): TemplateResult {
    const { shown, language, tool } = this;
    const isPainting = tool === "paint";
    const isPlacing = places(tool);
    const isEditing = isPainting || isPlacing;
    const walls_mm = isEditing ? null : this.walls_mm;
    // A model is edited alone, and so are its walls seen; its copies follow.
    const isPlate = this.copies.length > 0 && !isEditing && walls_mm === null;
    const isMeasured = this.look === "distance" && !isEditing && walls_mm === null;
    const isPrinted = isMeasured || (this.look === "printed" && !isEditing && walls_mm === null);
    // An aligned view shows all of the model, and from the side only: no single steps, no top to paint or to see walls from, no
    // bottom to support, and no plate with copies.
    const isAligned = this.aligned && !isEditing && !isPrinted && !isPlate && walls_mm === null;
    const showsHeat = this.#showsHeat;
    const points = this.#placed?.of(tool);
    // Supports and holes keep off what weighs much in the plan.
    const heat = isPlacing ? "product" : this.colours === "layers" ? "paint" : this.colours;
    const { texts } = language;
    const words = texts.view;
    const isTurned = this.rotation.some((part, i) => part !== (i === 3 ? 1 : 0));
    return html`
      <h3 class="visually-hidden">${words.title}</h3>
      ${viewBar({
        tool,
        isPrinted,
        isMeasured,
        isSafe: this.palette === "safe",
        isAligned: isAligned && this.canAlign,
        isBeside: this.plot === null ? null : this.canAlign && !isPlate,
        isTurned,
        offered: this.#offered,
        isPossible: !this.isMissing && !this.isBroken,
        language,
        chosen: (tool) => (this.tool = tool),
        printed: (on) => this.#look(on ? "printed" : "thickness"),
        measured: (on) => this.#look(on ? "distance" : "printed"),
        safe: this.#otherPalette,
        aligned: this.#align,
        upright: this.#upright,
      })}
      <div class="stage">
      <div class="view">
        ${this.isThere
          ? html`<cusp-view
              .positions=${this.positions}
              .rotation=${this.rotation}
              .scale=${this.#scale}
              .lift_mm=${shown?.lift_mm ?? 0}
              .supports=${this.#supports}
              .voids=${shown?.voids ?? null}
              .points=${points?.list ?? NO_POINTS}
              .point=${points?.place ?? null}
              @cusp-point=${({ detail }: CustomEvent<PointDetail>) => this.#placed?.act(tool, detail)}
              .z_mm=${shown?.z_mm ?? []}
              .thickness_mm=${shown?.thickness_mm ?? []}
              .limits=${shown?.limits ?? [0, 0]}
              .layer=${shown === null || showsHeat || isPlacing || walls_mm !== null ? null : this.layer}
              .marks=${this.marks}
              .plate=${volumeOf(this.printer)}
              .look=${showsHeat ? "weights" : isEditing ? "thickness" : walls_mm === null ? this.look : "walls"}
              .wall_mm=${walls_mm ?? FACTS.limits.wall_mm}
              .weights=${this.weights}
              .saliency=${heat === "saliency" || this.#counts ? this.saliency : null}
              .heat=${heat}
              .least=${Number(this.settings.weightMin)}
              .brush=${this.brush}
              .copies=${isPlate ? this.standing : NO_COPIES}
              .selected=${isPlate ? this.#selected : null}
              @cusp-move=${(event: CustomEvent<MoveDetail>) => this.#tell(event)}
              @cusp-select=${this.#pressed}
              @cusp-paint=${this.#painted}
              .showsLegend=${tool !== "drains" || showsHeat}
              .palette=${this.palette}
              .tool=${tool}
              .aligned=${isAligned && this.plot !== null}
              .plot=${this.plot?.over ?? null}
              .heights_mm=${isAligned ? (this.plot?.heights_mm ?? null) : null}
              .near=${isPrinted}
              .texts=${this.#words()}
              @cusp-rotate=${(event: CustomEvent<RotateDetail>) => this.#tell(event)}
              @cusp-layer=${(event: CustomEvent<number>) => this.#tell(event)}
              @cusp-camera=${(event: CustomEvent<Rotation>) => this.#tell(event)}
              @cusp-beside=${this.#besides}
              @cusp-view-error=${() => (this.isBroken = true)}
            ></cusp-view>`
          : this.isMissing
            ? partFailure(language, () => void this.#load())
            : nothing}
      </div>
      ${isEditing ? html`<div class="beside">${isPainting ? this.#paintTools() : this.#pointTools()}</div>` : nothing}
      </div>
    `;
  }

  /** The place of the copy that the model is drawn as; null while its positions arrive. */
  get #selected(): number | null {
    const own = this.copies.filter(({ entry }) => entry.model === this.#shownModel);
    return (own.find(({ place }) => place === this.pressed) ?? own[0])?.place ?? null;
  }

  /** The supports of the model, on a plate those of its copies. */
  get #supports(): Float32Array | null {
    const place = this.#selected;
    return this.standing.find((copy) => copy.place === place)?.supports ?? this.shown?.supports ?? null;
  }

  readonly #pressed = ({ detail: place }: CustomEvent<number>): void => {
    this.pressed = place;
    const entry = this.copies.find((copy) => copy.place === place)?.entry;
    if (entry !== undefined && entry.model !== this.model) this.#say<Entry>("cusp-entry", entry);
  };

  async #load(): Promise<void> {
    this.isMissing = false;
    try {
      const { CuspView, CuspWallLegend } = await fetchView();
      await this.#turn;
      define("cusp-view", CuspView);
      define("cusp-wall-legend", CuspWallLegend);
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

  /** Leaves the tools that have their own colours. */
  #look(look: Look): void {
    this.look = look;
    this.#endWalls();
    this.#endEditing();
  }

  #endEditing(): void {
    if (this.tool === "paint" || places(this.tool)) this.tool = "turn";
  }

  /** Leaves the colours of walls, where other ones are asked for. */
  #endWalls(): void {
    if (this.walls_mm !== null) this.#say("cusp-walls", null);
  }

  /** Leaves what needs another camera. */
  readonly #align = (on: boolean): void => {
    this.aligned = on;
    if (!on) return;
    this.#endWalls();
    this.#endEditing();
    this.look = "thickness";
  };

  /** In the next frame: in this one the layout is being settled. */
  readonly #besides = ({ detail }: CustomEvent<boolean>): void => {
    this.#canAlign = detail;
    requestAnimationFrame(() => (this.canAlign = this.#canAlign));
  };

  /** Returns true if the view shows weights: while they are painted, and while supports or holes are placed that keep off the largest ones. */
  get #showsHeat(): boolean {
    const { tool, colours, settings, weights } = this;
    return tool === "paint" ? colours !== "layers" : places(tool) && settings.spare === "on" && (weights !== null || this.#counts);
  }

  /** Returns true if saliency counts in the plan. */
  get #counts(): boolean {
    return this.settings.saliency === "on";
  }

  /** The tools that there is something for: copies to move, and points to place on a model that is to be printed in resin. */
  get #offered(): ReadonlySet<Tool> {
    const { settings: { format, wall }, edited } = this;
    const offered = new Set<Tool>(this.copies.length > 0 ? ["move"] : []);
    if (edited === null || isFilament(format)) return offered;
    offered.add("supports");
    if (wall.trim() !== "") offered.add("drains");
    return offered;
  }

  /** What places points; null while it is not needed, or not there. */
  get #placed(): PointEditor | null {
    const { tool, edited, slicer } = this;
    if (!places(tool) || pointCode.code === null || edited === null || slicer === null) return null;
    this.#points ??= new pointCode.code.PointEditor(edited, slicer, () => this.requestUpdate());
    return this.#points;
  }

  #pointTools(): TemplateResult | typeof nothing {
    const { language, tool } = this;
    if (pointCode.code === null) return pointCode.instead(this, language);
    adopt(this, pointCode.code.pointStyles);
    return this.#placed?.tools(tool, language) ?? nothing;
  }

  #paintTools(): TemplateResult | typeof nothing {
    if (paintCode.code === null) return paintCode.instead(this, this.language);
    adopt(this, paintCode.code.paintStyles);
    const { brush, colours, settings, isFinding, canUndo, canRedo, language } = this;
    const view = (): CuspView | null => this.renderRoot.querySelector("cusp-view");
    const isPainted = this.weights !== null;
    const give = (weights: Float32Array | null): void => {
      this.canUndo = true;
      this.#say<Painted>("cusp-paint", { weights, final: true });
    };
    return paintCode.code.paintTools({
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
    this.#shownModel = null;
    this.positions = null;
    this.saliency = null;
    this.brush = BRUSH;
    this.canUndo = this.canRedo = false;
    if (model === null || slicer === null) return;
    // Without positions the view is empty; a broken worker is reported elsewhere.
    const positions = this.corners ?? (await slicer.positions().catch(() => null));
    await this.#turn;
    if (this.#asked !== model) return;
    this.#shownModel = model;
    this.positions = positions;
    this.brush = { ...BRUSH, size_mm: BRUSH_PART * this.#reach };
  }
}
