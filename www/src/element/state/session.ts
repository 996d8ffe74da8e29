/**
 * What an element is doing: one model, its settings, the last good result, and at most one task at a time.
 *
 * No DOM here: an element (or a test) hosts it, is told when something changed, and draws what it finds.
 */
import { asSlicerError, isAbort, type SlicerError } from "../../api/error.js";
import type { Model, Plan, Mask, PrintFile, Slicer, Watch } from "../../api/index.js";
import type { Backend, Candidate, Options, TradeoffPoint } from "../../api/wire.js";
import { sameRays } from "../../api/wire.js";
import type { Source } from "../../api/source.js";
import { choose, weightsName } from "./choice.js";
import { Curve } from "./curve.js";
import { OrientationSearch } from "./orientation.js";
import { Follower, type Rotation } from "./follow.js";
import { layerAt } from "../../view/scene/lookup.js";
import { METRICS } from "./metric.js";
import type { Failure } from "./problem.js";
import type { Busy } from "../parts/progress.js";
import { areSame, shownOf, type Result, type Shown } from "./result.js";
import * as round from "./round.js";
import { DEFAULT_SETTINGS, layerRange, rotationText, withTolerance, type Settings } from "./settings.js";
import { Preferences } from "./preferences.js";

export interface Download {
  name: string;
  blob: Blob;
}

/** What a session tells its host, besides that something changed. */
export interface Host {
  requestUpdate(): void;
  loaded?(model: Model): void;
  planned?(result: Result): void;
  failed?(error: SlicerError): void;
  cancelled?(): void;
  progressed?(busy: Busy): void;
  settingsChanged?(settings: Settings): void;
  /** There is more to choose from. */
  offered?(): void;
  painted?(weights: Float32Array | null, isFinal: boolean): void;
  oriented?(candidate: Candidate): void;
}

export interface Setup {
  settings?: Settings;
  backend?: Backend | null;
}

type SlicerCalls = Pick<
  Slicer,
  "load" | "plan" | "orient" | "mask" | "export" | "tradeoff" | "glance" | "printers" | "warm" | "setWeights" | "weightsFile" | "readWeights"
>;

export class Session extends Preferences {
  model: Model | null = null;
  result: Result | null = null;
  busy: Busy | null = null;
  failure: Failure | null = null;
  /** Something worth saying that is no failure. */
  notice: "cancelled" | "exportCancelled" | null = null;
  /** The layer looked at, from 0. */
  layer = 0;
  mask: Mask | null = null;
  /** How much each facet matters, 0 to 1, as painted; null: all alike. */
  weights: Float32Array | null = null;
  /** What charts and the view draw; null before there is a plan. */
  shown: Shown | null = null;
  /** Files that came together, and which of them is open. */
  files: readonly File[] = [];
  place = 0;

  readonly orientation: OrientationSearch;

  readonly #host: Host;
  readonly #slicer: SlicerCalls;
  readonly #curve = new Curve();
  readonly #follower: Follower;
  /** What runs. `options` are those of a plan, and null for anything else. */
  #task: { abort: AbortController; options: Options | null; weights: Float32Array | null } | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Options to plan with when the task under way has ended. */
  #next: Options | null = null;
  #idling = false;
  #maskOf: Result | null = null;
  /** The weights that the result is of. */
  #weightsOf: Float32Array | null = null;
  /** Whether the newest plan asked for has not come about. */
  #failed = false;
  #archive: { of: Result; file: PrintFile } | null = null;

  constructor(host: Host, slicer: SlicerCalls, { settings = DEFAULT_SETTINGS, backend = null }: Setup = {}) {
    super(settings, backend);
    this.#host = host;
    this.#slicer = slicer;
    this.orientation = new OrientationSearch(
      {
        subject: () => {
          const { model, options, weights } = this;
          return model === null || options === null ? null : { name: model.name, options, weights };
        },
        changed: () => this.#changed(),
        progressed: (busy) => this.#host.progressed?.(busy),
        failed: (error) => this.#fail(error, this.model?.name ?? "", this.settings),
      },
      slicer,
    );
    this.#follower = new Follower(slicer, (shown) => {
      this.shown = shown;
      this.#changed();
    });
  }

  /** The best plans of the model, from the tightest tolerance to the loosest; null until they are known. */
  get curve(): readonly TradeoffPoint[] | null {
    return this.#curve.points;
  }

  /** How the model is turned while it is held; null while it is not. */
  get turning(): Rotation | null {
    return this.#follower.turning;
  }

  /** Starts the worker and asks what there is to choose from. */
  start(): void {
    this.#slicer.warm();
    // A worker that does not start says so when it is asked for more than a list.
    void this.#slicer.printers().then(
      (printers) => {
        this.printers = printers;
        this.#host.offered?.();
        this.#changed();
      },
      () => undefined,
    );
  }

  /** Whether settings were changed that will be planned by after a pause. */
  get isPending(): boolean {
    return this.#timer !== undefined;
  }

  /** Whether the result on show is of earlier settings, because those on show give none. */
  get earlier(): boolean {
    return this.result !== null && this.busy === null && (Object.keys(this.faults).length > 0 || this.#failed);
  }

  /** The tolerance that the core took because none was typed for the metric on show; null if it is not known. */
  get taken(): number | null {
    const { result, settings } = this;
    return result?.report.metric === settings.metric && result.options.tolerance === undefined ? result.report.tolerance : null;
  }

  /** Takes the STLs of a drop or a dialogue: the first is opened, the others wait. */
  async choose(files: readonly File[]): Promise<Model | null> {
    if (files.length === 0) return null;
    const { files: before, place } = this;
    this.files = choose(files);
    const model = await this.openFile(0);
    // What cannot be opened leaves what was there.
    if (model === null) [this.files, this.place] = [before, place];
    return model;
  }

  /** Opens another of the files that came together. */
  async openFile(place: number): Promise<Model | null> {
    const file = this.files[place];
    if (file === undefined) return null;
    this.place = place;
    return this.#open(file, file.name);
  }

  /** Opens a model that stands alone; null if that failed or was cancelled. */
  async open(source: Source, name?: string): Promise<Model | null> {
    this.files = [];
    return this.#open(source, name);
  }

  /** Follows a model that is turned: by glances while it is held, by a plan when it is let go. */
  turn(rotation: Rotation, isFinal: boolean): void {
    if (!isFinal) return this.#follower.turn(rotation, this.options);
    this.#follower.stop();
    this.change({ rotation: rotationText(rotation) });
  }

  /** Stands the model as a candidate of {@link orientation} does. */
  orient(candidate: Candidate): void {
    const { rotation, size_mm } = candidate;
    this.#follower.stop();
    // A height is that of the model as it stands: another pose must not change its scale.
    const height = this.settings.height.trim() === "" ? {} : { height: String(Number(size_mm[2].toFixed(6))) };
    this.change({ rotation: rotationText(rotation), ...height });
    if (this.options !== null) this.orientation.applied(this.options);
    this.#host.oriented?.(candidate);
  }

  /** Follows weights that are painted: by glances during a stroke, by a plan at its end. */
  setWeights(weights: Float32Array | null, isFinal: boolean): void {
    this.weights = weights;
    // Weights that the core refuses make the plan fail, which says so.
    if (this.model !== null) this.#slicer.setWeights(weights).catch(() => undefined);
    this.#host.painted?.(weights, isFinal);
    const { options } = this;
    if (!isFinal) {
      if (options !== null) void this.#follower.follow(options);
      return;
    }
    this.#follower.stop();
    this.#curve.forget();
    this.replan();
  }

  /** Takes the weights of a file; what is wrong with it is shown. */
  async openWeights(file: File): Promise<void> {
    const { model } = this;
    try {
      const weights = await this.#slicer.readWeights(file);
      if (this.model === model) this.setWeights(weights, true);
    } catch (error) {
      if (this.model === model && !isAbort(error)) this.#fail(error, file.name, this.settings);
      this.#changed();
    }
  }

  /** A file of the weights on show; null if all facets are alike. */
  async saveWeights(): Promise<Download | null> {
    const { weights, model } = this;
    if (weights === null || model === null) return null;
    return { name: weightsName(model.name), blob: await this.#slicer.weightsFile(weights) };
  }

  /** Takes the tolerance of a point of the curve, as if it had been typed. */
  takePoint(index: number): void {
    const point = this.curve?.[index];
    if (point !== undefined) this.change(this.#within(point));
  }

  /** The change of settings that gives the plan of a point. */
  #within(point: TradeoffPoint): Partial<Settings> {
    const { scale, tolerances } = METRICS[this.settings.metric];
    // Where a plan has no error at all, its tolerance is less than any that can be asked for.
    const tolerance = Math.max(round.up(point.tolerance * scale), tolerances[0]);
    return withTolerance(this.settings, String(tolerance));
  }

  /** From 0, the quickest print worth having, to 1, the finest; at once or as soon as the curve is known. */
  set quality(quality: number | null) {
    this.#curve.wanted = quality;
    this.#takeQuality();
  }

  get quality(): number | null {
    const { wanted } = this.#curve;
    return wanted ?? (this.result === null ? null : this.#curve.placeOf(this.result.report));
  }

  /** Whether the result on show is what the settings ask for. */
  get isCurrent(): boolean {
    return this.result !== null && areSame(this.result.options, this.options) && this.#weightsOf === this.weights;
  }

  replan(delay_ms = 0): void {
    this.#forgetTimer();
    this.#changed();
    const { options } = this;
    if (options === null || this.model === null) return;
    if (delay_ms === 0) return void this.#plan(options);
    this.#timer = setTimeout(() => {
      this.#timer = undefined;
      void this.#plan(options);
    }, delay_ms);
  }

  /** Stops the task under way, whatever stage it is in. The last good result stays. */
  cancel(): void {
    if (this.busy === null) return;
    const { task } = this.busy;
    this.#drop();
    this.notice = task === "export" ? "exportCancelled" : "cancelled";
    this.#host.cancelled?.();
    this.#changed();
    void this.#idle();
  }

  /** Makes the print file of the result on show; null if cancelled or failed. */
  async export(): Promise<PrintFile | null> {
    const { result, model } = this;
    if (result === null || model === null || this.busy !== null) return null;
    if (this.#archive?.of === result) return this.#archive.file;
    this.failure = null;
    const file = await this.#run("export", model.name, null, (watch) => this.#slicer.export(undefined, watch));
    void this.#resume();
    if (file !== null) this.#archive = { of: result, file };
    return file;
  }

  selectLayer(layer: number): void {
    if (this.result === null) return;
    this.layer = Math.min(Math.max(0, Math.round(layer)), this.result.report.layers - 1);
    this.#changed();
    void this.#idle();
  }

  dismiss(): void {
    this.failure = null;
    this.notice = null;
    this.#changed();
  }

  async #open(source: Source, name?: string): Promise<Model | null> {
    this.#drop();
    this.notice = null;
    this.failure = null;
    const shown = name ?? (source instanceof URL || typeof source === "string" ? String(source).split("/").at(-1) ?? "" : "");
    const model = await this.#run("open", shown, null, (watch) =>
      this.#slicer.load(source, name === undefined ? watch : { ...watch, name }),
    );
    if (model === null) {
      await this.#resume();
      return null;
    }
    this.#next = null;
    // How the model before was turned says nothing about this one.
    if (this.model !== null && this.settings.rotation !== "") this.preset({ rotation: "" });
    this.model = model;
    this.result = null;
    this.shown = null;
    this.#follower.stop();
    this.weights = null;
    this.mask = null;
    this.orientation.forget();
    this.#curve.forget();
    this.#host.loaded?.(model);
    this.replan();
    return model;
  }

  protected override preferred(delay_ms: number): void {
    this.failure = null;
    this.notice = null;
    this.#host.settingsChanged?.(this.settings);
    this.replan(delay_ms);
  }

  async #plan(options: Options): Promise<void> {
    const { model } = this;
    if (model === null) return;
    if (this.#task !== null) {
      if (areSame(this.#task.options, options) && this.#task.weights === this.weights) {
        this.#next = null;
        return;
      }
      // A plan through other rays is not worth its time any more. Anything else may end first: a plan over the same
      // rays is nearly there, and what it has sampled serves the next one.
      if (this.#task.options === null || sameRays(this.#task.options, options)) {
        this.#next = options;
        return;
      }
      this.#drop();
    }
    this.failure = null;
    this.#failed = true;
    const { weights } = this;
    const plan = await this.#run("plan", model.name, options, (watch) => this.#slicer.plan(options, watch));
    if (plan !== null) this.#show(plan, options, weights);
    await this.#resume();
  }

  /** Plans with the settings that came while something else was under way; else sees to what can wait. */
  async #resume(): Promise<void> {
    const next = this.#next;
    if (this.#task !== null) return;
    if (next === null) return this.#idle();
    this.#next = null;
    await this.#plan(next);
  }

  #show(plan: Plan, options: Options, weights: Float32Array | null): void {
    const { report } = plan;
    this.#failed = false;
    const before = this.result?.report;
    const z = before?.z_mm[this.layer];
    const result = { ...plan, options, limits: layerRange(options) };
    this.result = result;
    this.#weightsOf = weights;
    this.shown = shownOf(report, plan.profile, result.limits);
    // Keep looking at the same height, or at the middle of a new model.
    this.layer = layerAt(report.z_mm, z === undefined ? report.height_mm / 2 : (z * report.height_mm) / (before?.height_mm ?? 1));
    if (before === undefined && this.notice === "cancelled") this.notice = null;
    this.mask = before === undefined ? null : this.mask;
    this.#curve.fit(result);
    this.#host.planned?.(result);
    this.#changed();
  }

  /** Runs one task, with progress shown. Null if it was cancelled or failed; a failure is shown. */
  async #run<T>(task: Busy["task"], name: string, options: Options | null, call: (watch: Watch) => Promise<T>): Promise<T | null> {
    const { settings, weights } = this;
    const mine = { abort: new AbortController(), options, weights };
    this.#task = mine;
    const busy: Busy = { task, name, stage: task === "export" ? "masks" : "load", fraction: 0, started_ms: performance.now() };
    this.busy = busy;
    this.#changed();
    const onProgress: Watch["onProgress"] = (stage, fraction) => {
      if (this.#task !== mine) return;
      this.busy = { ...busy, stage, fraction };
      this.#host.progressed?.(this.busy);
      this.#changed();
    };
    try {
      const value = await call({ signal: mine.abort.signal, onProgress });
      // Something else may have begun while the answer was on its way.
      return this.#task === mine ? value : null;
    } catch (error) {
      if (this.#task === mine && !isAbort(error)) this.#fail(error, name, settings);
      return null;
    } finally {
      if (this.#task === mine) {
        this.#task = null;
        this.busy = null;
        this.#changed();
      }
    }
  }

  #fail(thrown: unknown, name: string, settings: Settings): void {
    const error = asSlicerError(thrown);
    const own_mm = this.model?.info.size_mm[2] ?? null;
    const asked_mm = Number(settings.height.replace(",", "."));
    this.failure = { error, name, settings, height_mm: own_mm === null ? null : asked_mm > 0 ? asked_mm : own_mm };
    this.#host.failed?.(error);
  }

  #forgetTimer(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
  }

  /** Abandons whatever is under way or waiting. */
  #drop(): void {
    this.#forgetTimer();
    this.#next = null;
    const task = this.#task;
    this.#task = null;
    this.busy = null;
    task?.abort.abort();
  }

  /**
   * Fetches what is shown beside a plan: the mask of the layer looked at, and when that is there the curve. One call at
   * a time, and none while a task runs: the worker would not answer, and when it ends this is called again.
   */
  async #idle(): Promise<void> {
    if (this.#idling) return;
    this.#idling = true;
    try {
      while (this.result !== null && this.#task === null) {
        const fetched = (await this.#fetchMask(this.result)) || (await this.#fetchCurve(this.result));
        if (!fetched) break;
      }
    } catch (error) {
      if (this.#task === null && this.model !== null && !isAbort(error)) {
        this.#fail(error, this.model.name, this.settings);
        this.#changed();
      }
    } finally {
      this.#idling = false;
    }
  }

  /** Whether there was a mask to fetch. The newest layer wins. */
  async #fetchMask(result: Result): Promise<boolean> {
    const { layer } = this;
    if (this.mask?.layer === layer && this.#maskOf === result) return false;
    const mask = await this.#slicer.mask(layer);
    if (this.result === result) {
      this.mask = mask;
      this.#maskOf = result;
      this.#changed();
    }
    return true;
  }

  /** Whether there was a curve to fetch. */
  async #fetchCurve(result: Result): Promise<boolean> {
    if (!(await this.#curve.fetch(this.#slicer, result))) return false;
    this.#changed();
    this.#takeQuality();
    return true;
  }

  #takeQuality(): void {
    const index = this.#curve.takeWanted();
    const point = index === null ? undefined : this.curve?.[index];
    if (point !== undefined) this.preset(this.#within(point));
  }

  #changed(): void {
    this.#host.requestUpdate();
  }
}
