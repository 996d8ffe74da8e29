/** The models of a session: opens, adds, selects and paints them, one task at a time. */
import { asSlicerError, isAbort } from "../../api/error.js";
import type { Model, Plan, Watch } from "../../api/index.js";
import type { Source } from "../../api/source.js";
import type { Options, ReadOptions } from "../../api/wire.js";
import type { Busy } from "../parts/progress.js";
import { choose, projectName, weightsName } from "./choice.js";
import type { Download, Host, SlicerCalls } from "./host.js";
import { Plate, poseOf, type Added, type Entry, type Own, type PlateState, type Posed } from "./plate.js";
import { Preferences } from "./preferences.js";
import { readPrinter } from "./printer.js";
import { mirroredPose } from "./mirrored.js";
import type { Failure } from "./problem.js";
import { Runner } from "./runner.js";
import { aboutSelected, type ModelCalls } from "./selected.js";
import { check, fromAddress, toAddress, withoutPlaced, type Settings } from "./settings.js";
import type { Pose, Snapshot } from "./snapshot.js";

/** Codes with which the core refuses a printer's description. */
const OF_PRINTER: ReadonlySet<string> = new Set(["bad-options", "bad-printer"]);

export abstract class Models extends Preferences {
  /** The open model, or the selected one of several. */
  model: Model | null = null;
  failure: Failure | null = null;
  /** Notice that is not a failure. */
  notice: "cancelled" | "exportCancelled" | null = null;
  /** Importance of each facet, 0 to 1, as painted; null: all equal. */
  weights: Float32Array | null = null;
  /** Corners of the open model's facets for a view; null if not read together with it. */
  positions: Float32Array | null = null;
  /** Files opened together. */
  files: readonly File[] = [];
  /** All models, of which {@link model} is the selected one. */
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
  /** Forgets the state of the previous model; with `isNew`, also that of its plan. */
  protected abstract left(isNew: boolean): void;
  /** Continues work that waited for the end of a task. */
  protected abstract resume(): Promise<void>;
  /** Aborts the running task, and drops any pending one. */
  protected abstract drop(): void;
  /** Previews the weights during a stroke, or plans with them at its end. */
  protected abstract painted(isFinal: boolean): void;

  /** Progress of the running task; null if none runs. */
  get busy(): Busy | null {
    return this.runner.busy;
  }

  /** Opens the first model of a drop or a file dialog and keeps the others; null if this failed or was cancelled. */
  async choose(files: readonly File[]): Promise<Model | null> {
    if (files.length === 0) return null;
    const { files: before } = this;
    this.files = choose(files);
    const model = await this.openFile(0);
    // If the file cannot be opened, the previous files stay.
    if (model === null) this.files = before;
    return model;
  }

  /** Index of the open one of {@link files}. */
  get place(): number {
    return Math.max(0, this.files.findIndex((file) => file === this.model?.file));
  }

  /** Opens another of the files opened together; null if this failed or was cancelled. */
  async openFile(place: number): Promise<Model | null> {
    const file = this.files[place];
    return file === undefined ? null : this.#open(file, file.name);
  }

  /**
   * Opens a single model; null if this failed or was cancelled.
   *
   * @param waits true if its plan must wait, as for further models
   */
  async open(source: Source, name?: string, waits = false): Promise<Model | null> {
    this.files = [];
    return this.#open(source, name, waits);
  }

  /** Opens all models of a drop or a file dialog as one job; null if the first cannot be opened or if cancelled. */
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

  /** Adds models, each with its own pose and copies; if none is open, opens the first. Null if this failed or was cancelled. */
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
      // The failure stays visible, and so does the previous plan.
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

  /** Work that another session can go on with; null without a model. */
  get snapshot(): Snapshot | null {
    if (this.model === null) return null;
    this.keepPose();
    return { query: toAddress(this.settings, Infinity), ...this.plate.snapshot };
  }

  /** Goes on with the work of a snapshot, in place of the open models; null if this failed or was cancelled. */
  async reopen(snapshot: Snapshot): Promise<Model | null> {
    this.start();
    this.drop();
    this.dismiss();
    const name = snapshot.models[0]?.name ?? "";
    const entry = await this.run("open", name, null, (watch) => this.plate.reopen(snapshot, { ...watch, ...this.#shown() }));
    if (entry === null) {
      await this.resume();
      return null;
    }
    const { model, weights, positions } = entry;
    Object.assign(this, { model, weights, positions, files: [] });
    this.left(true);
    this.restore(fromAddress(snapshot.query));
    for (const { model } of this.plate.entries) this.host.loaded?.(model);
    this.replan();
    return model;
  }

  /** Opens a file if it is a project; false if it is none. */
  async openProject(file: File): Promise<boolean> {
    this.start();
    try {
      const project = await this.slicer.readProject(file);
      if (project === null) return false;
      const { snapshotIn } = await import("./project.js");
      await this.reopen(snapshotIn(project, this.settings));
      return true;
    } catch (error) {
      this.refuse(error, file.name);
      return true;
    }
  }

  /** File of the work as a project; null without a model or while a setting is invalid. */
  async saveProject(): Promise<Download | null> {
    const { snapshot, options } = this;
    if (snapshot === null || options === null) return null;
    const { formOf } = await import("./project.js");
    const blob = await this.slicer.writeProject(this.plate.project(options, formOf(snapshot)));
    return { name: projectName(snapshot.models[0]?.name ?? ""), blob };
  }

  /** Sets the weights: previews them during a stroke, and plans at its end. */
  setWeights(weights: Float32Array | null, isFinal: boolean): void {
    this.weights = weights;
    this.plate.paint(weights);
    this.host.painted?.(weights, isFinal);
    this.painted(isFinal);
  }

  /** Chooses the printer described by a file. If the core refuses it, nothing changes, and the failure is shown. */
  async openPrinter(file: File): Promise<void> {
    if (this.fixed.has("printer")) return;
    let { settings } = this;
    try {
      const printer = await readPrinter(file);
      settings = { ...settings, printer };
      // The core checks a printer with any options; this is the one such call that needs no model.
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

  /** File of the current weights; null if there are none. */
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

  /**
   * Reads the selected model again with other reading options, such as another plate of its project; null if this failed or was cancelled.
   */
  async reread(reading: ReadOptions): Promise<Model | null> {
    const { model } = this;
    return model === null ? null : this.#open(model.file, model.name, false, reading);
  }

  /** Mirrors the selected model from left to right as it stands, with its points and weights. Null if this failed or was cancelled. */
  async mirror(): Promise<Model | null> {
    const { model, settings, weights } = this;
    if (model === null) return null;
    const { mirrored = false } = model.reading;
    const other = await this.#open(model.file, model.name, true, { ...model.reading, mirrored: !mirrored });
    if (other === null) return null;
    this.preset(mirroredPose(settings));
    if (weights === null) this.replan();
    else this.setWeights(weights, true);
    return other;
  }

  /** @param reading options for reading the selected model again in place */
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
    // The rotation, unit and points of the previous model do not apply to this one.
    const foreign = { ...withoutPlaced(this.settings), rotation: "", unit: "" } as const;
    if (this.model !== null && Object.entries(foreign).some(([key, value]) => this.settings[key as keyof Settings] !== value)) this.preset(foreign);
    this.model = model;
    this.weights = null;
    this.positions = positions;
    this.left(true);
    this.host.loaded?.(model);
    if (!waits) this.replan();
    return model;
  }

  /** Makes another model of the plate the open one. */
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

  /** Requests the corners if the host shows the model. */
  #shown(): { positions?: true } {
    return this.host.hasView?.() === true ? { positions: true } : {};
  }

  /** Stores the pose of the selected model, which is in the settings while it is selected. */
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

  /** The pose in the settings; also as options, unless a setting is invalid. */
  #posed(): Posed {
    const { rotation, height, points, fill, drains, drain } = this.settings;
    const pose = { rotation, height, points, fill, drains, drain };
    const own = this.#ownOf(pose);
    return { pose, ...(own !== null && { own }) };
  }

  /** Options of a model in a pose, with the current settings; null if one is invalid. */
  #ownOf(pose: Pose): Own | null {
    const { printers, resins } = this;
    const checked = check(posedSettings(this.settings, pose), { printers, resins });
    return checked.ok ? ownOf(checked.options) : null;
  }

  /** Shows the reason for which something cannot be used. */
  refuse(error: unknown, name: string, settings = this.settings): void {
    this.fail(error, name, settings);
    this.changed();
  }

  /** Runs one task and shows its progress and any failure; null if it was cancelled or failed. */
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

/** The part of the options that belongs to a single model. */
function ownOf({ rotation, height_mm, hollow, supports }: Options): Own {
  return { ...(rotation !== undefined && { rotation }), ...(height_mm !== undefined && { height_mm }), ...(hollow && { hollow }), ...(supports && { supports }) };
}

/** Settings for a model in a pose. Automatic drain holes are a shared setting for all models without holes by hand. */
function posedSettings(settings: Settings, { rotation, height, points, fill, drains, drain }: Pose): Settings {
  const own = { rotation, height, ...(points !== "" && { points, fill }), ...(drains !== "" && { drains, drain }) };
  return { ...settings, ...withoutPlaced(settings), ...own };
}

/** Name of a source while it is read. */
function nameOf(source: Source): string {
  if (source instanceof File) return source.name;
  return source instanceof URL || typeof source === "string" ? (String(source).split("/").at(-1) ?? "") : "";
}
