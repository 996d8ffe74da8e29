/** The 3-D view of the model and its tools. The view, including three.js, is fetched when first shown. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { Model } from "../../api/index.js";
import type { ModelCalls } from "../state/selected.js";
import { FACTS, isFilament } from "../../api/facts.js";
import type { Printer } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import type { Mark } from "../../view/scene/marker.js";
import type { Look } from "../../view/scene/model.js";
import type { Rotation } from "../../view/scene/pose.js";
import { heightOf } from "../../view/scene/turn.js";
import type { Copy as Standing } from "../../view/scene/copies.js";
import type { MoveDetail, SelectDetail } from "../../view/scene/moving.js";
import { BRUSH, rebased } from "../../view/paint/brush.js";
import type { CuspView } from "../../view/cusp-view.js";
import type { CopiesDetail, MenuDetail, PaintDetail, PointDetail, RotateDetail, SizeDetail } from "../../view/events.js";
import type { Tool } from "../../view/scene/keys.js";
import { places } from "../../view/scene/places.js";
import { fetchRest } from "../../texts/index.js";
import type { ViewTexts } from "../../view/texts.js";
import { volumeOf } from "../parts/build-volume.js";
import { PlateView, type Shapes } from "../parts/plate-view.js";
import type { Painted } from "../events.js";
import { define } from "../define.js";
import { fetched } from "../parts/fetched.js";
import { adopt, FetchedPanel, partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import type { Colours } from "./paint-tools.js";
import type { Edited, PointEditor } from "./point-tools.js";
import type { Placement } from "./placement-fields.js";
import type { PlotPlace } from "./profile-chart.js";
import type { Copy, Entry } from "../state/plate.js";
import type { Shown } from "../state/result.js";
import { DEFAULT_SETTINGS } from "../state/settings.js";
import { modelViewStyles } from "../styles/model-view-styles.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Few people paint or place points, so this code is fetched on demand. */
const paintCode = new FetchedPanel("paint", () => import("./paint-tools.js"));
const pointCode = new FetchedPanel("points", () => import("./point-tools.js"));

/** Initial size of the brush, as a fraction of the model's longest side. */
const BRUSH_PART = 0.2;

/** The view appears after the first plan, or this long after the model was read. */
const LATEST_MS = 700;

const fetchCode = fetched(() => import("../../view/cusp-view.js"));
const fetchTools = fetched(() => import("./view-tools.js"));

/** Fetches the view, and then its tools. */
export const fetchView = async (): Promise<{ view: typeof import("../../view/cusp-view.js"); tools: ViewTools }> => ({ view: await fetchCode(), tools: await fetchTools() });

type ViewTools = typeof import("./view-tools.js");

/** Constant, since a new array would count as a change. */
const NO_POINTS: CuspView["points"] = [];
const NO_COPIES: readonly Standing[] = [];
const NO_PLACES: readonly Mark[] = [];
const NO_PLACED: readonly number[] = [];

/** Copies to duplicate or remove, by their indices; none for a single model. */
export interface CopiesEvent {
  readonly do: CopiesDetail;
  readonly places: readonly number[];
}

export interface Scaled {
  readonly height_mm: number;
  readonly rotation: Rotation;
}

const PROPERTIES = {
  slicer: given<ModelCalls | null>(null),
  /** The open model; a change fetches its positions. */
  model: given<Model | null>(null),
  /** Positions of the model, if read together with it. */
  corners: given<Float32Array | null>(null),
  /** True during the first plan of the model. The view waits for it, since both compete for the processor. */
  isPlanning: given(false),
  shown: given<Shown | null>(null),
  layer: given(0),
  /** The chosen finding, on each copy. */
  marks: given<readonly Mark[]>([]),
  /** All findings that need attention, on each copy. */
  places: given<readonly Mark[]>([]),
  /** Wall thickness below which the model is marked, mm; null hides the thickness colours. */
  walls_mm: given<number | null>(null),
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** Height of the scaled model, and the pose in which it has that height; null for the file's own size. */
  scaled: given<Scaled | null>(null, (a: unknown, b: unknown) => JSON.stringify(a) !== JSON.stringify(b)),
  printer: given<Pick<Printer, "volume_mm"> | null>(null),
  /** Copies on the plate shown; empty for a single model. */
  copies: given<readonly Copy[]>([]),
  /** Indices of copies that overlap others or extend beyond the plate. */
  colliding: given<ReadonlySet<number>>(new Set()),
  /** Source of the positions of the plate's models. */
  shapes: given<Shapes | null>(null),
  language: given(languageOf()),
  /** The chart's plot and its heights, with which the view aligns when next to it; null without a chart. */
  plot: given<PlotPlace | null>(null),
  /** True if the plot is next to the view. */
  canAlign: own(false),
  positions: own<Float32Array | null>(null),
  /** The tools of the view, fetched with it; null before. */
  tools: own<ViewTools | null>(null),
  /** True if fetching it failed. */
  isMissing: own(false),
  /** True if the browser has no WebGL. */
  isBroken: own(false),
  tool: own<Tool>("turn"),
  look: own<Look>("thickness"),
  /** True to align heights with the chart, when it is next to the view and neither painting nor the printed look need another camera. */
  aligned: own(false),
  settings: given(DEFAULT_SETTINGS),
  /** The session for placing points by hand, with the settings above; null if that is not possible. */
  edited: given<Edited | null>(null),
  /** Importance of each facet; null: all equal. */
  weights: given<Float32Array | null>(null),
  /** Saliency of each facet; null until needed. */
  saliency: own<Float32Array | null>(null),
  isFinding: own(false),
  brush: own(BRUSH),
  colours: own<Colours>("product"),
  canUndo: own(false),
  canRedo: own(false),
  /** Copies as the view draws them. */
  standing: own<readonly Standing[]>([]),
  /** Indices of the copies selected in the view, the last one pressed at the end. */
  pressed: own<readonly number[]>([]),
  /** True if what is above the selected layer is cut off. */
  isCut: own(false),
  /** Factor of the current change of size. */
  factor: own(1),
  /** The size asked for, until the plan has it. */
  sized: own<Scaled | null>(null),
  isMenuOpen: own(false),
};

export class CuspModel extends elementWith(PROPERTIES) {
  /** Scale factor from the file to the model. */
  #scale = 1;
  /** The selected copy as a list, cached, since a new array would count as a change. */
  #alone: readonly number[] | null = null;
  #texts: { of: Language; words: ViewTexts } | null = null;
  #asked: Model | null = null;
  /** Resolves when the view may start: the model's first plan is painted, or takes long. */
  #turn: Promise<unknown> = Promise.resolve();
  /** Ends that wait early. */
  #next: (() => void) | null = null;
  #canAlign = false;
  #points: PointEditor | null = null;
  readonly #plate = new PlateView((copies) => (this.standing = copies));
  /** The model whose positions are shown. */
  #shownModel: Model | null = null;

  static override styles = [
    shared,
    partStyles,
    modelViewStyles,
  ];

  override firstUpdated(): void {
    void this.#load();
  }

  override updated(): void {
    // A layout may put other content over the view, which makes room for the tools.
    this.toggleAttribute("editing", this.#isEditing);
    if (this.isPlanning || this.#next === null) return;
    const next = this.#next;
    this.#next = null;
    // Callbacks of a frame run before it is painted.
    requestAnimationFrame(() => setTimeout(next));
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("model") && this.model !== this.#asked) {
      if (this.isPlanning) this.#turn = new Promise<void>((resolve) => setTimeout((this.#next = resolve), LATEST_MS));
      void this.#fetch();
    }
    if (changed.has("scaled") || changed.has("model")) this.sized = null;
    if (changed.has("positions") || changed.has("scaled") || changed.has("sized")) this.#fit();
    if (changed.has("copies") && changed.get("copies")?.length !== this.copies.length) this.pressed = [];
    if (changed.has("copies") || changed.has("colliding") || changed.has("positions")) {
      this.#plate.show(this.copies, this.colliding, this.shapes);
    }
    if ((this.tool === "move" || places(this.tool)) && !this.#offered.has(this.tool)) this.tool = "turn";
    const isPainting = this.tool === "paint";
    // Starts the preview worker early, so that it has read the model before the first turn or stroke.
    if (changed.has("tool") && (isPainting || this.tool === "rotate")) this.slicer?.preview().catch(() => undefined);
    const needsSaliency = this.#counts ? isPainting || this.#showsHeat : isPainting && this.colours === "saliency";
    if (needsSaliency && this.positions !== null && this.saliency === null && !this.isFinding) void this.#find();
  }

  override render(): TemplateResult {
    const { shown, language, tool } = this;
    const isPainting = tool === "paint";
    const isPlacing = places(tool);
    const isEditing = this.#isEditing;
    const walls_mm = isEditing ? null : this.walls_mm;
    // Editing and wall thickness show the model alone, without its copies.
    const isPlate = this.copies.length > 0 && !isEditing && walls_mm === null;
    // Findings are at places of the plate.
    const hasFindings = isPlate || this.copies.length === 0;
    const isMeasured = this.look === "distance" && !isEditing && walls_mm === null;
    const isPrinted = isMeasured || (this.look === "printed" && !isEditing && walls_mm === null);
    // An aligned view shows the whole model from the side only, which rules out the printed look, painting, walls, supports and plates of
    // copies.
    const isAligned = this.aligned && !isEditing && !isPrinted && !isPlate && walls_mm === null;
    const showsHeat = this.#showsHeat;
    const points = this.#placed?.of(tool);
    // While placing points, show the weights that supports and holes avoid: those that count in the plan.
    const heat = isPlacing ? "product" : this.colours === "layers" ? "paint" : this.colours;
    const { tools } = this;
    return html`
      <h3 class="visually-hidden">${language.texts.view.title}</h3>
      ${tools === null ? html`<div class="bar-place"></div>` : this.#bar(tools, { isPrinted, isMeasured, isAligned, isPlate })}
      <div class="stage">
      <div class="view">
        ${tools !== null
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
              .marks=${hasFindings ? this.marks : NO_PLACES}
              .places=${hasFindings && !isEditing ? this.places : NO_PLACES}
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
              .chosen=${isPlate ? this.#chosen : NO_PLACED}
              .cuts=${this.isCut}
              @cusp-move=${(event: CustomEvent<MoveDetail>) => this.#tell(event)}
              @cusp-size=${({ detail }: CustomEvent<SizeDetail>) => this.#size(detail)}
              @cusp-select=${({ detail }: CustomEvent<SelectDetail>) => this.#press(detail)}
              @cusp-copies=${({ detail }: CustomEvent<CopiesDetail>) => this.#copies(detail)}
              @cusp-menu=${this.#openMenu}
              @cusp-paint=${this.#painted}
              .showsLegend=${tool !== "drains" || showsHeat}
              .tool=${tool}
              .aligned=${isAligned && this.plot !== null}
              .plot=${this.plot?.over ?? null}
              .heights_mm=${isAligned ? (this.plot?.heights_mm ?? null) : null}
              .near=${isPrinted}
              .texts=${this.#words(tools)}
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
      ${tools === null ? nothing : this.#menu(tools)}
    `;
  }

  #bar(
    { viewBar, placementFields }: ViewTools,
    { isPrinted, isMeasured, isAligned, isPlate }: Readonly<Record<"isPrinted" | "isMeasured" | "isAligned" | "isPlate", boolean>>,
  ): TemplateResult {
    const { tool, language } = this;
    const placement = this.#placement;
    return viewBar({
      tool,
      isPrinted,
      isMeasured,
      isAligned: isAligned && this.canAlign,
      isBeside: this.plot !== null && this.canAlign && !isPlate,
      isCut: this.isCut,
      isTurned: this.rotation.some((part, i) => part !== (i === 3 ? 1 : 0)),
      offered: this.#offered,
      isPossible: !this.isBroken,
      language,
      below: placement === null ? nothing : placementFields(tool, placement),
      chosen: (tool) => (this.tool = tool),
      printed: (on) => this.#look(on ? "printed" : "thickness"),
      measured: (on) => this.#look(on ? "distance" : "printed"),
      aligned: this.#align,
      cut: (on) => (this.isCut = on),
      upright: this.#upright,
    });
  }

  /** The menu of the selected model, opened by the secondary button. */
  #menu({ placementMenu, steppedInMenu }: ViewTools): TemplateResult {
    const placement = this.isMenuOpen ? this.#placement : null;
    const toggled = ({ newState }: ToggleEvent): void => {
      if (newState === "closed") this.isMenuOpen = false;
    };
    return html`<div class="menu" popover role="menu" aria-label=${this.language.texts.view.title} @keydown=${steppedInMenu} @toggle=${toggled}>
      ${placement === null ? nothing : placementMenu(this.#offered, placement, () => this.#menuElement?.hidePopover())}
    </div>`;
  }

  get #menuElement(): HTMLElement | null {
    return this.renderRoot.querySelector(".menu");
  }

  readonly #openMenu = async ({ detail: { at: [x, y], place } }: CustomEvent<MenuDetail>): Promise<void> => {
    if (this.positions === null || this.#isEditing) return;
    if (place !== null && !this.#chosen.includes(place)) this.#press({ place, isMore: false });
    this.isMenuOpen = true;
    await this.updateComplete;
    const menu = this.#menuElement;
    const view = this.renderRoot.querySelector("cusp-view")?.getBoundingClientRect();
    if (menu === null || view === undefined) return;
    menu.showPopover();
    const { width, height } = menu.getBoundingClientRect();
    menu.style.left = `${Math.min(view.left + x, innerWidth - width)}px`;
    menu.style.top = `${Math.min(view.top + y, innerHeight - height)}px`;
    menu.querySelector("button")?.focus();
  };

  /** The selected model's placement; null until its positions are there. */
  get #placement(): Placement | null {
    const { positions, rotation, language } = this;
    if (positions === null) return null;
    const copy = this.standing.find(({ place }) => place === this.#selected) ?? null;
    return {
      positions,
      rotation,
      language,
      copy,
      scale: this.#scale * this.factor,
      chosen: (tool) => (this.tool = tool),
      rotated: (rotation) => this.#say<RotateDetail>("cusp-rotate", { rotation, final: true }),
      sized: (factor) => this.#size({ factor, final: true }),
      moved: (to) => copy !== null && this.#say<MoveDetail>("cusp-move", { copies: [{ place: copy.place, ...to }], final: true }),
      mirrored: () => this.#say("cusp-mirror", null),
      duplicated: () => this.#copies("duplicate"),
      removed: () => this.#copies("remove"),
    };
  }

  /** Scales the model: at the end of the change, the height in the settings is the new one. */
  #size({ factor, final }: SizeDetail): void {
    this.factor = final ? 1 : factor;
    const { positions, rotation } = this;
    if (!final || positions === null) return;
    const height_mm = heightOf(positions, rotation) * this.#scale * factor;
    this.sized = { height_mm, rotation };
    this.#say("cusp-settings", { height: String(Math.round(height_mm * 1000) / 1000) });
  }

  #copies(what: CopiesDetail): void {
    this.#say<CopiesEvent>("cusp-copies", { do: what, places: this.#chosen });
  }

  /** Index of the copy that stands for the selected model; null until its positions arrive. */
  get #selected(): number | null {
    const own = this.copies.filter(({ entry }) => entry.model === this.#shownModel);
    const last = this.pressed.at(-1);
    return (own.find(({ place }) => place === last) ?? own[0])?.place ?? null;
  }

  /** Supports of the model; on a plate, each copy has its own. */
  get #supports(): Float32Array | null {
    const place = this.#selected;
    return this.standing.find((copy) => copy.place === place)?.supports ?? this.shown?.supports ?? null;
  }

  /** Indices of the selected copies. */
  get #chosen(): readonly number[] {
    const selected = this.#selected;
    if (selected === null) return NO_PLACED;
    if (this.pressed.includes(selected)) return this.pressed;
    return (this.#alone = this.#alone?.[0] === selected ? this.#alone : [selected]);
  }

  #press({ place, isMore }: SelectDetail): void {
    const others = isMore ? this.#chosen.filter((other) => other !== place) : [];
    const isLeaving = isMore && this.#chosen.includes(place) && others.length > 0;
    this.pressed = isLeaving ? others : [...others, place];
    const last = this.pressed.at(-1);
    const entry = this.copies.find((copy) => copy.place === last)?.entry;
    if (entry !== undefined && entry.model !== this.model) this.#say<Entry>("cusp-entry", entry);
  }

  async #load(): Promise<void> {
    this.isMissing = false;
    try {
      const { view: { CuspView, CuspWallLegend }, tools } = await fetchView();
      await fetchRest();
      await this.#turn;
      define("cusp-view", CuspView);
      define("cusp-wall-legend", CuspWallLegend);
      for (const styles of [tools.barStyles, tools.placementStyles]) adopt(this, styles);
      this.tools = tools;
    } catch (error) {
      this.isMissing = true;
      tellPartFailed(this, "view", error);
    }
  }

  /** Leaves the tools that use their own colours. */
  #look(look: Look): void {
    this.look = look;
    this.#endWalls();
    this.#endEditing();
  }

  #endEditing(): void {
    if (this.#isEditing) this.tool = "turn";
  }

  /** Returns true while the model is painted or gets points. */
  get #isEditing(): boolean {
    return this.tool === "paint" || places(this.tool);
  }

  /** Hides the wall thickness colours when others are requested. */
  #endWalls(): void {
    if (this.walls_mm !== null) this.#say("cusp-walls", null);
  }

  /** Aligning leaves every mode that needs another camera. */
  readonly #align = (on: boolean): void => {
    this.aligned = on;
    if (!on) return;
    this.#endWalls();
    this.#endEditing();
    this.look = "thickness";
  };

  /** Deferred to the next frame, since this one is still being laid out. */
  readonly #besides = ({ detail }: CustomEvent<boolean>): void => {
    this.#canAlign = detail;
    requestAnimationFrame(() => (this.canAlign = this.#canAlign));
  };

  /** Returns true if the view shows weights: while they are painted, and while supports or holes that avoid large weights are placed. */
  get #showsHeat(): boolean {
    const { tool, colours, settings, weights } = this;
    return tool === "paint" ? colours !== "layers" : places(tool) && settings.protect === "on" && (weights !== null || this.#counts);
  }

  /** Returns true if saliency counts in the plan. */
  get #counts(): boolean {
    return this.settings.saliency === "on";
  }

  /** Available tools: moving copies, and placing points on a model for resin. */
  get #offered(): ReadonlySet<Tool> {
    const { settings: { format, wall }, edited } = this;
    const offered = new Set<Tool>(this.copies.length > 0 ? ["move"] : []);
    if (edited === null || isFilament(format)) return offered;
    offered.add("supports");
    if (wall.trim() !== "") offered.add("drains");
    return offered;
  }

  /** The point editor; null if not needed or not yet fetched. */
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
    const { positions } = this;
    const scaled = this.sized ?? this.scaled;
    const own_mm = positions === null || scaled === null ? 0 : heightOf(positions, scaled.rotation);
    this.#scale = own_mm > 0 ? (scaled?.height_mm ?? own_mm) / own_mm : 1;
  }

  /** Longest side of the model at its current scale, mm: the maximum size of the brush. */
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
    // Without saliency nothing is shown; a broken worker is reported elsewhere.
    const saliency = await slicer.saliency().catch(() => new Float32Array(0));
    this.isFinding = false;
    if (this.model === model) this.saliency = saliency;
  }

  #say<Detail>(type: string, detail: Detail): void {
    this.dispatchEvent(new CustomEvent<Detail>(type, { detail }));
  }

  /** Cached per language: a new object would count as a change of the texts. */
  #words(tools: ViewTools): ViewTexts {
    if (this.#texts?.of !== this.language) this.#texts = { of: this.language, words: tools.viewTexts(this.language) };
    return this.#texts.words;
  }

  /** Re-fires an event of the view, since those do not bubble. */
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
