/** The models of a session: opened, added, selected and painted. One task at a time reads them, or works with them. */
import { asSlicerError, isAbort } from "../../api/error.js";
import type { Model, Plan, Watch } from "../../api/index.js";
import type { Source } from "../../api/source.js";
import type { Options, ReadOptions } from "../../api/wire.js";
import type { Busy } from "../parts/progress.js";
import { choose, weightsName } from "./choice.js";
import type { Download, Host, SlicerCalls } from "./host.js";
import { Plate, poseOf, type Added, type Entry, type Own, type PlateState, type Pose, type Posed } from "./plate.js";
import { Preferences } from "./preferences.js";
import { readPrinter } from "./printer.js";
import type { Failure } from "./problem.js";
import { Runner } from "./runner.js";
import { aboutSelected, type ModelCalls } from "./selected.js";
import { check, withoutPlaced, type Settings } from "./settings.js";

/** What the core finds wrong with a printer's description. */
const OF_PRINTER: ReadonlySet<string> = new Set(["bad-options", "bad-printer"]);

export abstract class Models extends Preferences {
  /** The open model: if there are several, the selected one. */
  model: Model | null = null;
  failure: Failure | null = null;
  /** A notice to show that is not a failure. */
  notice: "cancelled" | "exportCancelled" | null = null;
  /** How much each facet matters, 0 to 1, as painted; null: all equally. */
  weights: Float32Array | null = null;
  /** The corners of the facets of the open model for a view; null if they did not come with it. */
  positions: Float32Array | null = null;
  /** Files that were opened together, and the index of the open one. */
  files: readonly File[] = [];
  place = 0;
  /** The models, of which {@link model} is the selected one. */
  readonly plate: Plate;
  /** Calls of the slicer about the selected model. */
  readonly selected: ModelCalls;

  protected readonly host: Host;
  protected readonly slicer: SlicerCalls;
  protected readonly runner: Runner;

  constructor(host: Host, slicer: SlicerCalls, ...[settings, backend]: ConstructorParameters<typeof Preferences>) {
    super(settings, backend);
    this.host = host;
    this.slicer = slicer;
    this.runner = new Runner({ changed: () => this.changed(), progressed: (busy) => host.progressed?.(busy) });
    this.plate = new Plate(
      {
        changed: () => this.changed(),
        changing: (kind) => this.#changing(kind),
        replate: () => this.replate(),
        show: (plan) => this.showPlate(plan),
        selected: (entry) => this.#select(entry),
        own: (pose) => this.#ownOf(pose),
      },
      slicer,
    );
    this.selected = aboutSelected(slicer, () => this.plate.selectedId);
  }

  /** Prepares for the first model. */
  abstract start(): void;
  /** Plans the models now, or after a pause. */
  abstract replan(delay_ms?: number): void;
  /** Plans again after a change of the models: the running plan is for the earlier ones. */
  protected abstract replate(): void;
  /** Shows the plan of another plate, for the same options. */
  protected abstract showPlate(plan: Plan): void;
  /** Forgets what belongs to another model; with `isNew`, also what belongs to its plan. */
  protected abstract left(isNew: boolean): void;
  /** Does what had to wait for a task. */
  protected abstract resume(): Promise<void>;
  /** Aborts the running task, and drops any waiting one. */
  protected abstract drop(): void;
  /** Previews the weights during a stroke, or plans with them at its end. */
  protected abstract painted(isFinal: boolean): void;

  /** The progress of the running task; null if none runs. */
  get busy(): Busy | null {
    return this.runner.busy;
  }

  /** Opens the first model of a drop or a file dialog and keeps the others; null if that failed or was cancelled. */
  async choose(files: readonly File[]): Promise<Model | null> {
    if (files.length === 0) return null;
    const { files: before, place } = this;
    this.files = choose(files);
    const model = await this.openFile(0);
    // If the file cannot be opened, the previous files stay.
    if (model === null) [this.files, this.place] = [before, place];
    return model;
  }

  /** Opens another of the files that were opened together; null if that failed or was cancelled. */
  async openFile(place: number): Promise<Model | null> {
    const file = this.files[place];
    if (file === undefined) return null;
    this.place = place;
    return this.#open(file, file.name);
  }

  /**
   * Opens a single model; null if that failed or was cancelled.
   *
   * @param waits whether its plan has to wait, as for other models
   */
  async open(source: Source, name?: string, waits = false): Promise<Model | null> {
    this.files = [];
    return this.#open(source, name, waits);
  }

  /** Opens all models of a drop or a file dialog, as models of one job; null if the first cannot be opened or that was cancelled. */
  async openAll(files: readonly File[]): Promise<Model | null> {
    const [first, ...others] = choose(files);
    if (first === undefined) return null;
    const model = await this.open(first, first.name, others.length > 0);
    if (model !== null && others.length > 0) await this.add(others);
    return model;
  }

  /** Adds the models of a drop or a file dialog to the open one; without one, opens them. */
  async add(files: readonly File[]): Promise<readonly Model[] | null> {
    if (this.model !== null) return this.addAll(choose(files).map((source) => ({ source, own: {} })));
    const model = await this.openAll(files);
    return model === null ? null : [model];
  }

  /** Adds models, each in a pose and with copies of its own; without an open one, opens the first. Null if that failed or was cancelled. */
  async addAll(added: readonly Added[]): Promise<readonly Model[] | null> {
    const [first, ...others] = added;
    if (first === undefined) return [];
    if (this.model === null) {
      const model = await this.#openAs(first, others.length > 0);
      if (model === null) return null;
      const more = await this.addAll(others);
      return more === null ? null : [model, ...more];
    }
    this.drop();
    this.dismiss();
    const entries = await this.run("open", first.name ?? nameOf(first.source), null, (watch) => this.plate.add(added, { ...watch, ...this.#shown() }));
    if (entries === null) {
      // What went wrong stays on show, and so does the plan before.
      await this.resume();
      return null;
    }
    const models = entries.map(({ model }) => model);
    for (const model of models) this.host.loaded?.(model);
    this.replate();
    return models;
  }

  async #openAs({ source, own, name }: Added, waits: boolean): Promise<Model | null> {
    const model = await this.open(source, name, true);
    if (model === null) return null;
    const { copies = 1, rotation, height_mm } = own;
    this.plate.keep({ copies });
    const pose = poseOf(own);
    if (rotation !== undefined) this.preset({ rotation: pose.rotation });
    if (height_mm !== undefined) this.preset({ height: pose.height });
    if (!waits) this.replan();
    return model;
  }

  /** Sets the weights: previews them during a stroke, and plans at its end. */
  setWeights(weights: Float32Array | null, isFinal: boolean): void {
    this.weights = weights;
    this.plate.paint(weights);
    this.host.painted?.(weights, isFinal);
    this.painted(isFinal);
  }

  /** Chooses the printer that a file describes. One that the core refuses changes nothing, and the failure is shown. */
  async openPrinter(file: File): Promise<void> {
    if (this.fixed.has("printer")) return;
    let { settings } = this;
    try {
      const printer = await readPrinter(file);
      settings = { ...settings, printer };
      // The core checks a printer with any options; of all calls, this one needs no model.
      await this.slicer.calibrateLayers({ printer }).catch((error: unknown) => {
        if (OF_PRINTER.has(asSlicerError(error).code)) throw error;
      });
      this.change({ printer });
    } catch (error) {
      this.refuse(error, file.name, settings);
    }
  }

  /** Reads the weights of a file and applies them; a failure is shown. */
  async openWeights(file: File): Promise<void> {
    const { model } = this;
    try {
      const weights = await this.selected.readWeights(file);
      if (this.model === model) this.setWeights(weights, true);
    } catch (error) {
      if (this.model === model && !isAbort(error)) this.refuse(error, file.name);
    }
  }

  /** A file of the current weights; null if there are none. */
  async saveWeights(): Promise<Download | null> {
    const { weights, model } = this;
    if (weights === null || model === null) return null;
    return { name: weightsName(model.name), blob: await this.selected.weightsFile(weights) };
  }

  dismiss(): void {
    this.failure = null;
    this.notice = null;
    this.changed();
  }

  /** Reads the selected model again with other choices, as another plate of its project; null if that failed or was cancelled. */
  async reread(reading: ReadOptions): Promise<Model | null> {
    const { model } = this;
    return model === null ? null : this.#open(model.file, model.name, false, reading);
  }

  /** @param reading that of the selected model, in whose place it is read again */
  async #open(source: Source, name?: string, waits = false, reading?: ReadOptions): Promise<Model | null> {
    this.start();
    this.drop();
    this.dismiss();
    const call = {
      ...(name !== undefined && { name }),
      ...this.#shown(),
      ...(reading !== undefined && { reading }),
    };
    const loaded = await this.run("open", name ?? nameOf(source), null, (watch) => this.plate.open(source, { ...watch, ...call }));
    if (loaded === null) {
      await this.resume();
      return null;
    }
    const { positions, model } = loaded;
    // The rotation of the previous model does not apply to this one, nor do its unit and its points.
    const foreign = { ...withoutPlaced(this.settings), rotation: "", unit: "" } as const;
    if (this.model !== null && Object.entries(foreign).some(([key, value]) => this.settings[key as keyof Settings] !== value)) this.preset(foreign);
    this.model = model;
    this.weights = null;
    this.positions = positions;
    this.left(true);
    this.forgetModels();
    this.host.loaded?.(model);
    if (!waits) this.replan();
    return model;
  }

  /** Takes another model of the plate as the open one. */
  #select(entry: Entry): void {
    this.left(false);
    const { model, weights, pose } = entry;
    this.settings = posedSettings(this.settings, pose);
    this.model = model;
    this.weights = weights;
    this.positions = null;
    this.host.settingsChanged?.(this.settings);
    this.replate();
  }

  /** Corners come with a model that is shown. */
  #shown(): { positions?: true } {
    return this.host.hasView?.() === true ? { positions: true } : {};
  }

  /** Keeps the pose of the selected model, which the settings have while it is selected. */
  protected keepPose(): void {
    this.plate.keep(this.#posed());
  }

  #changing(kind: string | null): void {
    if (kind === null) this.keepPose();
    else this.note(kind);
  }

  protected override standing(): PlateState {
    this.keepPose();
    return this.plate.state;
  }

  protected override stand(state: PlateState): boolean {
    if (!this.plate.restore(state, this.#posed())) return false;
    this.host.settingsChanged?.(this.settings);
    return true;
  }

  /** The pose that the settings say; as options, unless a setting is invalid. */
  #posed(): Posed {
    const { rotation, height, points, fill, drains, drain } = this.settings;
    const pose = { rotation, height, points, fill, drains, drain };
    const own = this.#ownOf(pose);
    return { pose, ...(own !== null && { own }) };
  }

  /** The options of a model in a pose, by the settings now; null if one is invalid. */
  #ownOf(pose: Pose): Own | null {
    const { printers, resins } = this;
    const checked = check(posedSettings(this.settings, pose), { printers, resins });
    return checked.ok ? ownOf(checked.options) : null;
  }

  /** Shows why something cannot be used. */
  refuse(error: unknown, name: string, settings = this.settings): void {
    this.fail(error, name, settings);
    this.changed();
  }

  /** Runs one task and shows its progress; null if it was cancelled or failed. A failure is shown. */
  protected run<T>(kind: Busy["task"], name: string, options: Options | null, call: (watch: Watch) => Promise<T>): Promise<T | null> {
    const { settings, weights } = this;
    return this.runner.run({ kind, name, options, weights }, (error) => this.fail(error, name, settings, kind), call);
  }

  protected fail(thrown: unknown, name: string, settings: Settings, task: Busy["task"] | null = null): void {
    const error = asSlicerError(thrown);
    const own_mm = this.model?.info.size_mm[2] ?? null;
    const asked_mm = Number(settings.height.replace(",", "."));
    this.failure = { error, task, name, settings, height_mm: own_mm === null ? null : asked_mm > 0 ? asked_mm : own_mm };
    this.host.failed?.(error);
  }

  protected changed(): void {
    this.host.requestUpdate();
  }
}

/** The options of a model alone. */
function ownOf({ rotation, height_mm, hollow, supports }: Options): Own {
  return { ...(rotation !== undefined && { rotation }), ...(height_mm !== undefined && { height_mm }), ...(hollow && { hollow }), ...(supports && { supports }) };
}

/** The settings for a model in a pose. Whether holes are made automatically holds for all that have none by hand. */
function posedSettings(settings: Settings, { rotation, height, points, fill, drains, drain }: Pose): Settings {
  const own = { rotation, height, ...(points !== "" && { points, fill }), ...(drains !== "" && { drains, drain }) };
  return { ...settings, ...withoutPlaced(settings), ...own };
}

/** What a source is called while it is read. */
function nameOf(source: Source): string {
  if (source instanceof File) return source.name;
  return source instanceof URL || typeof source === "string" ? (String(source).split("/").at(-1) ?? "") : "";
}
