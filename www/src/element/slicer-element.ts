/**
 * What every element around a slicer has: its properties, attributes, events and gestures, and the session behind them. How
 * the panels are laid out is a subclass's: in cards for pages of shops, as a workbench on our own.
 */
import { LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { SlicerError } from "../api/error.js";
import { createSlicer, type Model, type Plan, type PrintFile, type Slicer } from "../api/index.js";
import type { Source } from "../api/source.js";
import type { Backend, Format, GpuMethod, Metric, Printer, Resin } from "../api/wire.js";
import { fetchLanguage, languageOf } from "../texts/index.js";
import { Attributes, settingsOf } from "./state/attributes.js";
import { isFiles } from "./state/choice.js";
import type { CuspSlicerEvents } from "./events.js";
import { watchGestures } from "./gestures.js";
import { chosen } from "./parts/chosen.js";
import { langOf } from "./parts/lang.js";
import { DECLARATIONS, type SettingName } from "./properties.js";
import type { Facts } from "./facts.js";
import { Reports } from "./reports.js";
import { METRICS } from "./state/metric.js";
import { PANELS, type Panel } from "./state/panel-names.js";
import { definePanels } from "./panels/index.js";
import { explain } from "./state/problem.js";
import type { Result } from "./state/result.js";
import { saveFile, saveMade } from "./parts/save-file.js";
import { Session } from "./state/session.js";
import { fromAddress, parse, toAddress } from "./state/settings.js";
import { thumbnailOf } from "./parts/thumbnail.js";

export type State = "empty" | "busy" | "error" | "done" | "ready";

export abstract class SlicerElement extends LitElement {
  static override properties = { ...DECLARATIONS, dragging: { state: true } };

  /** URL of a model (3MF, OBJ or STL), opened when set. */
  declare src: string | null;
  /** @internal */
  declare dragging: boolean;

  /** The headless slicer behind the element; a page may call it for more than the element shows. */
  readonly slicer: Slicer = createSlicer();
  readonly #reports: Reports = new Reports(this, {
    isCurrent: () => this.#session.isCurrent,
    offered: () => this.#attributes.offered(),
  });
  readonly #session = new Session(this.#reports, this.slicer);
  readonly #attributes = new Attributes(this.#session, (error) => this.#misused(error));
  #locale: string | null = null;
  #panels: readonly Panel[] | null = null;
  #fixed: readonly SettingName[] | null = null;
  #started = false;

  constructor() {
    super();
    definePanels();
    this.src = null;
    this.dragging = false;
    watchGestures(this, {
      dragging: (isOver) => (this.dragging = isOver),
      open: (files) => void this.#choose(files),
      cancel: () => this.cancel(),
      undo: () => this.undo(),
      redo: () => this.redo(),
    });
  }

  override connectedCallback(): void {
    super.connectedCallback();
    if (!this.#started) this.#session.start();
    this.#started = true;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    // An element that was only moved is connected again by now.
    queueMicrotask(() => {
      if (this.isConnected) return;
      this.cancel();
      this.slicer.rest();
    });
  }

  /** empty, busy, ready (a model without a plan), done, or error; reflected in the attribute `state`. */
  get state(): State {
    const { busy, isPending, failure, result, model } = this.#session;
    if (busy !== null || isPending) return "busy";
    if (failure !== null) return "error";
    return result !== null ? "done" : model !== null ? "ready" : "empty";
  }

  /** The open model; null if there is none. */
  get model(): Model | null {
    return this.#session.model;
  }

  /** The last successful plan; null if there is none. */
  get result(): Result | null {
    return this.#session.result;
  }

  /** BCP 47 language tag; if null, the nearest `lang`, then the browser's languages. */
  get locale(): string | null {
    return this.#locale;
  }
  set locale(locale: string | null) {
    const read = this.#attributes.read("locale", locale);
    if (read === undefined) return;
    this.#locale = read;
    this.requestUpdate();
  }

  /** Panels to show, separated by spaces: see {@link PANELS}. Null shows all. */
  get panels(): string | null {
    return this.#panels?.join(" ") ?? null;
  }
  set panels(panels: string | null) {
    const read = this.#attributes.read("panels", panels);
    if (read === undefined) return;
    this.#panels = read;
    this.requestUpdate();
  }

  /**
   * Attributes that only the page may change, separated by spaces: printer, format, resin, metric, tolerance, layer-min,
   * layer-max. The form shows them read-only; undo, offers and the property `query` leave them alone.
   */
  get fixed(): string | null {
    return this.#fixed?.join(" ") ?? null;
  }
  set fixed(fixed: string | null) {
    const read = this.#attributes.read("fixed", fixed);
    if (read === undefined) return;
    this.#fixed = read;
    this.#session.fixed = settingsOf(read ?? []);
    this.requestUpdate();
  }

  /** Name of a printer (see `slicer.printers()`), or the description of another; empty for none. */
  get printer(): string | Printer {
    return this.#session.settings.printer;
  }
  set printer(printer: string | Printer | null) {
    this.#attributes.set("printer", printer);
  }

  /** Name of one of {@link resins}; empty for the default one. */
  get resin(): string {
    return this.#session.settings.resin;
  }
  set resin(resin: string | null) {
    this.#attributes.set("resin", resin);
  }

  /** Largest error of a layer: mm (cusp, deviation, roughness), a fraction (area) or mm³ (volume). Null for the default. */
  get tolerance(): number | null {
    const { metric, tolerances } = this.#session.settings;
    const typed = parse(tolerances[metric] ?? "");
    return typed === null ? null : typed / METRICS[metric].scale;
  }
  set tolerance(tolerance: number | null) {
    this.#attributes.set("tolerance", tolerance);
  }

  /** Minimum layer thickness in mm. */
  get layerMin(): number {
    return parse(this.#session.settings.layerMin) ?? Number.NaN;
  }
  set layerMin(mm: number | null) {
    this.#attributes.set("layer-min", mm);
  }

  /** Maximum layer thickness in mm. */
  get layerMax(): number {
    return parse(this.#session.settings.layerMax) ?? Number.NaN;
  }
  set layerMax(mm: number | null) {
    this.#attributes.set("layer-max", mm);
  }

  /** The metric of the tolerance. */
  get metric(): Metric {
    return this.#session.settings.metric;
  }
  set metric(metric: Metric | null) {
    this.#attributes.set("metric", metric);
  }

  /** The format of the print file; null for the printer's own. */
  get format(): Format | null {
    const { format } = this.#session.settings;
    return format === "" ? null : format;
  }
  set format(format: Format | null) {
    this.#attributes.set("format", format);
  }

  /**
   * Instead of a tolerance, a point on the trade-off curve from 0, the fastest print worth having, to 1, the finest.
   * Null until the curve is known.
   */
  get quality(): number | null {
    return this.#session.quality;
  }
  set quality(quality: number | null) {
    const read = this.#attributes.read("quality", quality);
    if (read !== undefined) this.#session.quality = read;
  }

  /** Where rays are cast: `cpu`, `gpu`, or null for whichever is faster. */
  get backend(): Backend | null {
    return this.#session.backend;
  }
  set backend(backend: Backend | null) {
    const read = this.#attributes.read("backend", backend);
    if (read === undefined) return;
    this.#session.backend = read;
    this.#session.replan();
  }

  /** How a GPU casts them: by `fill` or by depth peeling, `peel`; null for the faster one that it can do. */
  get gpuMethod(): GpuMethod | null {
    return this.#session.gpuMethod;
  }
  set gpuMethod(method: GpuMethod | null) {
    const read = this.#attributes.read("gpu-method", method);
    if (read === undefined) return;
    this.#session.gpuMethod = read;
    this.#session.replan();
  }

  /** How much each facet matters, 0 to 1 in the order of `slicer.positions()`; null: all equally. Setting it plans again. */
  get weights(): Float32Array | null {
    return this.#session.weights;
  }
  set weights(weights: Float32Array | null) {
    this.#session.setWeights(weights, true);
  }

  /** Resins to choose from; each needs a name. */
  get resins(): readonly Resin[] {
    return this.#session.resins;
  }
  set resins(resins: readonly Resin[]) {
    this.#session.resins = resins;
    this.#attributes.offered();
    this.requestUpdate();
  }

  /** All settings as a URL query, such as `metric=area&tolerance=5`; defaults are left out. */
  get query(): string {
    return toAddress(this.#session.settings);
  }
  set query(query: string) {
    this.#attributes.settle();
    this.#session.restore(fromAddress(query));
  }

  /**
   * Opens a model, or the first of several files, and starts to plan it.
   *
   * @throws SlicerError; an `AbortError` if it was cancelled, or if another model was opened meanwhile.
   */
  async load(source: Source | readonly File[], name?: string): Promise<Model> {
    const model = isFiles(source) ? await this.#choose(source) : await this.#session.open(source, name);
    if (model !== null) return model;
    throw this.#reason();
  }

  /** The plan for the settings. Rejects with `bad-options`, `no-model`, an `AbortError`, or the error of the plan. */
  plan(): Promise<Plan> {
    this.#attributes.settle();
    if (Object.keys(this.#session.faults).length > 0) {
      const system = Object.keys(this.#session.faults).join(", ");
      return Promise.reject(new SlicerError("bad-options", `settings are out of range: ${system}`, { system }));
    }
    if (this.model === null) return Promise.reject(new SlicerError("no-model", "load a model first"));
    const { result } = this;
    if (result !== null && this.#session.isCurrent && this.state === "done") return Promise.resolve(result);
    const planned = this.#reports.nextPlan();
    this.#session.replan();
    return planned;
  }

  /** The print file of that plan, not saved. Rejects with `no-plan` if no model is open, otherwise as {@link plan} does. */
  async export(): Promise<PrintFile> {
    if (this.model !== null) await this.plan();
    const download = await this.#session.export();
    if (download !== null) return download;
    throw this.result === null ? new SlicerError("no-plan", "plan the layers first") : this.#reason();
  }

  /**
   * A square PNG of the model in the layers of its plan, on a transparent background, for a basket or a list of orders.
   * Rejects with `part-failed` if the renderer cannot be loaded or there is no WebGL.
   *
   * @param size_px length of each side in pixels, clamped to 16 to 2048
   */
  async thumbnail(size_px = THUMBNAIL_PX): Promise<Blob> {
    await this.plan();
    const { result } = this;
    if (result === null) throw new SlicerError("no-plan", "plan the layers first");
    return thumbnailOf(this.slicer, result, size_px);
  }

  /** Stops the running task and an orientation search within 0.1 s; the last plan stays. */
  cancel(): void {
    this.#session.cancel();
    this.#session.orientation.cancel();
  }

  undo(): void {
    this.#session.undo();
  }

  redo(): void {
    this.#session.redo();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("src") && this.src !== null) void this.#session.open(this.src);
  }

  /** @internal The layout. */
  protected abstract layout(facts: Facts): TemplateResult;

  override render(): TemplateResult | typeof nothing {
    const session = this.#session;
    const arriving = fetchLanguage(...this.#locales);
    // Empty for a moment rather than in another language.
    if (arriving !== null) {
      void arriving.then(() => this.requestUpdate());
      return nothing;
    }
    const language = languageOf(...this.#locales);
    return this.layout({
      element: this,
      session,
      language,
      problem: session.failure === null ? null : explain(session.failure, language, session.fixed),
      panels: new Set(this.#panels ?? PANELS),
      slicer: this.slicer,
      isDragging: this.dragging,
      picked: this.#picked,
      added: (event) => void session.add(chosen(event)),
      save: () => void this.#save(),
      saveAll: () => void this.#saveAll(),
      saveTowers: () => void saveMade(session.calibrateLayers()),
      saveWeights: () => void saveMade(session.saveWeights()),
    });
  }

  override updated(): void {
    const before = this.getAttribute("state");
    this.setAttribute("state", this.state);
    // The button that opened the model is gone, and the focus with it: move the focus to the model's name.
    const root = this.renderRoot as ShadowRoot;
    if (before === "busy" && root.activeElement === null && this.#orphaned && this.model !== null) {
      this.#orphaned = false;
      root.querySelector<HTMLElement>(".model-name")?.focus({ preventScroll: true });
    }
  }

  /** Whether a model was opened with a button of the empty element, so that the focus will be lost. */
  #orphaned = false;

  /** @internal Called before a model is opened with a button that disappears once it is open. */
  willOrphan(): void {
    this.#orphaned = this.model === null;
  }

  /** @internal Whether files that are opened together stand on one plate; otherwise the first of them is opened. */
  protected get hasPlate(): boolean {
    return false;
  }

  #choose(files: readonly File[]): Promise<Model | null> {
    return this.hasPlate ? this.#session.openAll(files) : this.#session.choose(files);
  }

  get #locales(): readonly string[] {
    return [this.locale, langOf(this), ...navigator.languages].filter((locale) => locale !== null);
  }

  /** An invalid attribute concerns the page's developer: the element does not show it to customers. */
  #misused(error: SlicerError): void {
    console.warn(`<${this.localName}>: ${error.message}`, this);
    this.#reports.tell("cusp-error", error);
  }

  /** Why the last task gave no result. */
  #reason(): unknown {
    return this.#session.failure?.error ?? new DOMException("cancelled", "AbortError");
  }

  readonly #picked = (event: Event): void => {
    const files = chosen(event);
    if (files.length > 0) this.willOrphan();
    void this.#choose(files);
  };

  async #saveAll(): Promise<void> {
    for (let plate = 0; plate < this.#session.plate.plates; plate++) {
      const download = await this.#session.exportPlate(plate);
      if (download === null) return;
      if (this.#reports.tell("cusp-export", download)) saveFile(download);
    }
  }

  readonly #save = async (): Promise<void> => {
    const download = await this.#session.export();
    if (download !== null && this.#reports.tell("cusp-export", download)) saveFile(download);
  };
}

/** The default side length of a thumbnail in pixels. */
const THUMBNAIL_PX = 400;

declare global {
  interface HTMLElementEventMap extends CuspSlicerEvents {}
}
