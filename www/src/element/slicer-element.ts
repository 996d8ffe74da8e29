/**
 * Base class of elements around a slicer: properties, attributes, events, gestures, and the session. A subclass lays out the panels: as
 * cards for shop pages, or as a workbench on our own page.
 */
import { nothing, type PropertyValues, type TemplateResult } from "lit";
import { SlicerError } from "../api/error.js";
import type { Check, Model, Plan, PrintFile } from "../api/index.js";
import type { Source } from "../api/source.js";
import type { KnownPrinter, ModelOptions } from "../api/wire.js";
import { fetchLanguage, languageOf } from "../texts/index.js";
import { isFiles, isNamedAsProject } from "./state/choice.js";
import type { CuspSlicerEvents } from "./events.js";
import { watchGestures } from "./gestures.js";
import { chosen } from "./parts/chosen.js";
import { DECLARATIONS } from "./properties.js";
import type { Facts } from "./facts.js";
import { definePanels } from "./panels/index.js";
import { Explaining } from "./state/explaining.js";
import type { Result } from "./state/result.js";
import type { Snapshot } from "./state/snapshot.js";
import { saveFile, saveMade } from "./parts/save-file.js";
import { thumbnailOf } from "./parts/thumbnail.js";
import { SettableElement } from "./settable-element.js";
import { whenWanted } from "./when-wanted.js";

export type State = "empty" | "busy" | "error" | "done" | "ready";

/** A model of the element, with its number of copies and its own pose, if any. */
export interface ModelOnPlate extends Model {
  own: Pick<ModelOptions, "copies" | "rotation" | "height_mm">;
}

/** Handmade edits, lost when the page closes. */
export interface Handwork {
  isPainted: boolean;
  /** Points and drain holes, as in the settings of these names. */
  points: string;
  drains: string;
  models: number;
}

export abstract class SlicerElement extends SettableElement {
  static override properties = { ...DECLARATIONS, dragging: { state: true } };

  /** URL of a model (3MF, OBJ or STL), which is opened. */
  declare src: string | null;
  /** @internal */
  declare dragging: boolean;

  #life = new AbortController();
  readonly #explaining = new Explaining(() => this.requestUpdate());
  /** Models being added, one after the other. */
  #adding: Promise<unknown> = Promise.resolve();

  constructor() {
    super();
    definePanels();
    this.src = null;
    this.dragging = false;
    watchGestures(this, {
      dragging: (isOver) => (this.dragging = isOver),
      open: (files) => void this.take(files),
      refuse: (error, name) => this.refuse(error, name),
      cancel: () => this.cancel(),
      undo: () => this.undo(),
      redo: () => this.redo(),
    });
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#life = new AbortController();
    whenWanted(this, () => this.session.start(), this.#life.signal);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#life.abort();
    // If the element was only moved, it is connected again by now.
    queueMicrotask(() => {
      if (this.isConnected) return;
      this.cancel();
      this.slicer.rest();
    });
  }

  /** State of the element: empty, busy, ready (a model without a plan), done, or error; reflected in the attribute `state`. */
  get state(): State {
    const { busy, isPending, failure, result, model } = this.session;
    if (busy !== null || isPending) return "busy";
    if (failure !== null) return "error";
    return result !== null ? "done" : model !== null ? "ready" : "empty";
  }

  /** The open model, or the selected one of several; null if there is none. */
  get model(): Model | null {
    return this.session.model;
  }

  /** All models, in order. */
  get models(): readonly ModelOnPlate[] {
    return this.session.plate.entries.map(({ model, copies, own }) => ({ ...model, own: { copies, ...own } }));
  }

  /** The last successful plan; null if there is none. With several plates, that of the plate shown. */
  get result(): Result | null {
    return this.session.result;
  }

  /** The last successful plan of all plates, with their total time and resin; null if there is none. */
  get plates(): Plan | null {
    return this.session.plate.planned ?? this.result;
  }

  /** Findings on the last plan and the verdict; null until checked: see `limits`. */
  get check(): Check | null {
    return this.session.checks.check;
  }

  /**
   * Opens a model and starts to plan it. Given several files, puts all on one plate if the panel `plate` is shown; otherwise opens the
   * first.
   *
   * @throws a `SlicerError`; an `AbortError` if cancelled, or if another model was opened meanwhile.
   */
  async load(source: Source | readonly File[], name?: string): Promise<Model> {
    const model = isFiles(source) ? await this.#choose(source) : await this.session.open(source, name);
    if (model !== null) return model;
    throw this.#reason();
  }

  /**
   * Adds a model to the open ones, with its own copies and pose, and plans all together. If none is open, opens it.
   *
   * @throws the errors of {@link load}.
   */
  async add(source: Source, own: Partial<ModelOnPlate["own"]> = {}, name?: string): Promise<Model> {
    const added = { source, own, ...(name !== undefined && { name }) };
    const adding = this.#adding.then(() => this.session.addAll([added]));
    this.#adding = adding;
    const [model] = (await adding) ?? [];
    if (model !== undefined) return model;
    throw this.#reason();
  }

  /**
   * The plan for the settings; with several plates, that of the plate shown. Rejects with `bad-options`, `no-model`, an `AbortError`, or
   * the error of the plan.
   */
  plan(): Promise<Plan> {
    this.judged.settle();
    if (Object.keys(this.session.faults).length > 0) {
      const system = Object.keys(this.session.faults).join(", ");
      return Promise.reject(new SlicerError("bad-options", `settings are out of range: ${system}`, { system }));
    }
    if (this.model === null) return Promise.reject(new SlicerError("no-model", "load a model first"));
    const { result } = this;
    if (result !== null && this.session.isCurrent && this.state === "done") return Promise.resolve(result);
    const planned = this.reports.nextPlan();
    this.session.replan();
    return planned;
  }

  /**
   * Print file of that plan; does not save it. Rejects with `no-plan` if no model is open, otherwise as {@link plan} does.
   *
   * @param plate index of the plate, from 0; by default the one shown.
   */
  async export(plate?: number): Promise<PrintFile> {
    if (this.model !== null) await this.plan();
    const download = await (plate === undefined ? this.session.export() : this.session.exportPlate(plate));
    if (download !== null) return download;
    throw this.result === null ? new SlicerError("no-plan", "plan the layers first") : this.#reason();
  }

  /**
   * A square PNG of the open model in the layers of its plan, on a transparent background, for a basket or a list of orders. Rejects with
   * `part-failed` if the renderer cannot be loaded or WebGL is missing.
   *
   * @param size_px length of each side in pixels, clamped to 16 to 2048.
   */
  async thumbnail(size_px = THUMBNAIL_PX): Promise<Blob> {
    await this.plan();
    return this.lastThumbnail(size_px);
  }

  /** @internal The same of the last plan, without a new one. */
  async lastThumbnail(size_px: number): Promise<Blob> {
    const { result } = this;
    if (result === null) throw new SlicerError("no-plan", "plan the layers first");
    const { plate } = this.session;
    return thumbnailOf(this.session.selected, result, plate.heightOf(plate.selected) ?? result.report.height_mm, size_px);
  }

  /** Stops the running task and any orientation search within 0.1 s; the last plan stays. */
  cancel(): void {
    this.session.cancel();
    this.session.orientation.cancel();
  }

  /** Undoes the last change of settings, models, copies or places. */
  undo(): void {
    this.session.undo();
  }

  /** Repeats the last change that was undone. */
  redo(): void {
    this.session.redo();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("src") && this.src !== null) void this.session.open(this.src);
  }

  /** @internal Lays out the panels. */
  protected abstract layout(facts: Facts): TemplateResult;

  override render(): TemplateResult | typeof nothing {
    const session = this.session;
    const arriving = fetchLanguage(...this.#locales);
    // Renders nothing until the language arrives, rather than another language.
    if (arriving !== null) {
      void arriving.then(() => this.requestUpdate());
      return nothing;
    }
    const language = languageOf(...this.#locales);
    return this.layout({
      element: this,
      session,
      language,
      problem: this.#explaining.of(session.failure, language, session.fixed),
      panels: this.shownPanels,
      slicer: this.slicer,
      isDragging: this.dragging,
      picked: this.#picked,
      added: (event) => void this.take(chosen(event)),
      save: () => void this.#save(),
      saveAll: () => void this.#saveAll(),
      saveTowers: () => void saveMade(session.calibrateLayers()),
      saveBridges: () => void saveMade(session.calibrateCure()),
      saveWeights: () => void saveMade(session.saveWeights()),
    });
  }

  override updated(): void {
    const before = this.getAttribute("state");
    this.setAttribute("state", this.state);
    // The button that opened the model has gone, and the focus with it: focus the model's name.
    const root = this.renderRoot as ShadowRoot;
    if (before === "busy" && root.activeElement === null && this.#orphaned && this.model !== null) {
      this.#orphaned = false;
      root.querySelector<HTMLElement>(".model-name")?.focus({ preventScroll: true });
    }
  }

  /** True if a model was opened with a button of the empty element, which will take the focus with it. */
  #orphaned = false;

  /** @internal */
  handwork(): Handwork {
    const { plate: { entries }, settings: { points, drains } } = this.session;
    return { isPainted: entries.some(({ weights }) => weights !== null), points, drains, models: entries.length };
  }

  /** @internal Adds the models of a drop to the open ones; opens them if none is open or if only one can be. */
  async take(files: readonly File[]): Promise<void> {
    if (await this.#isProject(files)) return;
    await (this.#hasPlate && this.model !== null ? this.session.add(files) : this.#openModels(files));
  }

  /** @internal True if project files are opened as such, with all their settings. */
  protected readonly opensProjects: boolean = false;

  /** Opens the only file if it is a project; false if it is none. */
  async #isProject(files: readonly File[]): Promise<boolean> {
    const [file] = files;
    if (!this.opensProjects || file === undefined || files.length > 1 || !isNamedAsProject(file.name)) return false;
    return this.session.openProject(file);
  }

  /** @internal Saves the work as a project, unless the page does. */
  async saveProject(): Promise<void> {
    await saveMade(this.session.saveProject());
  }

  /** @internal Printers known by name; empty until the worker has started. */
  knownPrinters(): readonly KnownPrinter[] {
    return this.session.printers;
  }

  /** @internal Names of printers chosen before, the last first, which the list shows first. */
  get recentPrinters(): readonly string[] {
    return this.session.recent;
  }
  set recentPrinters(names: readonly string[]) {
    this.session.recent = names;
  }

  /** @internal Work that {@link reopen} goes on with, and the number of its set of models; null without a model. */
  work(): { job: number; snapshot: Snapshot } | null {
    const { snapshot, plate } = this.session;
    return snapshot === null ? null : { job: plate.state.job, snapshot };
  }

  /** @internal Goes on with earlier work; null if this failed or was cancelled. */
  reopen(snapshot: Snapshot): Promise<Model | null> {
    return this.session.reopen(snapshot);
  }

  /** @internal Shows the reason for which a drop or file cannot be opened. */
  refuse(error: SlicerError, name: string): void {
    this.session.refuse(error, name);
  }

  /** @internal Called before a model is opened with a button that disappears once it is open. */
  willOrphan(): void {
    this.#orphaned = this.model === null;
  }

  /** Returns true if files opened together are put on one plate; otherwise only the first is opened. */
  get #hasPlate(): boolean {
    return this.shownPanels.has("plate");
  }

  async #choose(files: readonly File[]): Promise<Model | null> {
    return (await this.#isProject(files)) ? this.model : this.#openModels(files);
  }

  #openModels(files: readonly File[]): Promise<Model | null> {
    return this.#hasPlate ? this.session.openAll(files) : this.session.choose(files);
  }

  get #locales(): readonly string[] {
    return [this.locale, langOf(this), ...navigator.languages].filter((locale) => locale !== null);
  }

  /** Reason for which the last task gave no result. */
  #reason(): unknown {
    return this.session.failure?.error ?? new DOMException("cancelled", "AbortError");
  }

  readonly #picked = (event: Event): void => {
    const files = chosen(event);
    if (files.length > 0) this.willOrphan();
    void this.#choose(files);
  };

  async #saveAll(): Promise<void> {
    for (let plate = 0; plate < this.session.plate.plates; plate++) {
      const download = await this.session.exportPlate(plate);
      if (download === null) return;
      if (this.reports.tell("cusp-export", download)) saveFile(download);
    }
  }

  readonly #save = async (): Promise<void> => {
    const download = await this.session.export();
    if (download !== null && this.reports.tell("cusp-export", download)) saveFile(download);
  };
}

/** Default side length of a thumbnail in pixels. */
const THUMBNAIL_PX = 400;

declare global {
  interface HTMLElementEventMap extends CuspSlicerEvents {}
}

/** Nearest `lang` of an element or its ancestors, across shadow roots; null if there is none. */
function langOf(element: Element): string | null {
  for (let at: Element | null = element; at !== null; ) {
    const found: Element | null = at.closest("[lang]");
    if (found !== null) return found.getAttribute("lang");
    const root: Node = at.getRootNode();
    at = root instanceof ShadowRoot ? root.host : null;
  }
  return null;
}
