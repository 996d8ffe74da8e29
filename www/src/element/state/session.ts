/**
 * State of an element: its models, their settings, the last good result, and at most one running task.
 *
 * It has no DOM: an element or a test hosts the session, receives its changes, and renders its state.
 */
import type { Mask, Plan, PrintFile, Watch } from "../../api/index.js";
import type { SlicerError } from "../../api/error.js";
import { FACTS, sameRays } from "../../api/facts.js";
import type { Candidate, CureFit, Options, Price, Resin, TradeoffPoint } from "../../api/wire.js";
import { BackgroundQueries } from "./background.js";
import { Checks } from "./checks.js";
import { Curve, withPoint } from "./curve.js";
import type { Download, Host, Setup, SlicerCalls } from "./host.js";
import { OrientationSearch, withPose, type Subject } from "./orientation.js";
import { LivePreview, type Rotation } from "./live-preview.js";
import { layerAt } from "../../view/scene/lookup.js";
import { Models } from "./models.js";
import type { Busy } from "../parts/progress.js";
import type { TowersState } from "../parts/towers-offer.js";
import { areSame, shownOf, type Result, type Shown } from "./result.js";
import { prepared } from "./prepared.js";
import { DEFAULT_SETTINGS, rotationText } from "./settings.js";
import { read } from "./typed.js";

/** Failures that may not recur on another try. */
const BY_CHANCE: ReadonlySet<string> = new Set(["crash", "start-failed", "worker-failed"]);

export class Session extends Models {
  result: Result | null = null;
  /** The selected layer, counted from 0. */
  layer = 0;
  /** Data for charts and the view; null before there is a plan. */
  shown: Shown | null = null;

  readonly orientation: OrientationSearch;
  readonly checks: Checks;

  #isStarted = false;
  readonly #curve = new Curve();
  readonly #background: BackgroundQueries;
  readonly #preview: LivePreview;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Options to plan with at the end of the running task. */
  #next: Options | null = null;
  /** Weights of the result. */
  #weightsOf: Float32Array | null = null;
  /** True if the newest plan has failed. */
  #failed = false;
  /** Input that the core refused to plan and would refuse again. */
  #refused: { options: Options; weights: Float32Array | null } | null = null;
  #archive: { of: Result; file: PrintFile } | null = null;

  constructor(host: Host, slicer: SlicerCalls, { settings = DEFAULT_SETTINGS, backend = null }: Setup = {}) {
    super(host, slicer, settings, backend);
    const reports = {
      changed: () => this.changed(),
      progressed: (busy: Busy) => host.progressed?.(busy),
      failed: (error: unknown) => this.fail(error, this.model?.name ?? "", this.settings),
    };
    const subject = (): Subject | null => {
      const { model, options, weights } = this;
      return model === null || options === null ? null : { name: model.name, options, weights };
    };
    this.orientation = new OrientationSearch({ ...reports, subject }, this.selected);
    const own = (): Result | null => this.result;
    this.checks = new Checks(
      {
        get result() {
          return own();
        },
        changed: reports.changed,
        wanted: () => void this.#background.fetch(),
        checked: (check) => host.checked?.(check),
        unchecked: (error) => host.unchecked?.(error),
        look: (layer) => this.selectLayer(layer),
      },
      slicer,
    );
    const isFree = (): boolean => this.runner.task === null;
    const prices = { priced: (price: Price) => host.priced?.(price), mispriced: (error: SlicerError) => host.mispriced?.(error) };
    this.#background = new BackgroundQueries(this, { ...reports, ...prices, isFree, curved: () => this.#takeQuality() }, this.plate, {
      curve: this.#curve,
      checks: this.checks,
    });
    this.#preview = new LivePreview(this.selected, (shown) => {
      this.shown = shown;
      this.changed();
    });
  }

  /** Mask of the selected layer; the previous mask until it arrives. */
  get mask(): Mask | null {
    return this.#background.mask;
  }

  /** Mask of the layer below, while its differences are looked at. */
  get maskBelow(): Mask | null {
    return this.#background.below;
  }

  /** True while changes from the layer below are looked at. */
  set seesChanges(on: boolean) {
    this.#background.seesChanges = on;
  }

  /** Prices of a shop, and the price of the result, or briefly of the previous one. */
  get pricing(): Pick<BackgroundQueries, "asked" | "price" | "isPriced"> {
    return this.#background;
  }

  /** The best plans of the model, from the tightest tolerance to the loosest; null until known. */
  get curve(): readonly TradeoffPoint[] | null {
    return this.#curve.points;
  }

  /** Rotation of the model while the user is turning it; otherwise null. */
  get turning(): Rotation | null {
    return this.#preview.turning;
  }

  /** Thicknesses of the test bridges as typed, and the print-through that fits them; null if there are too few. */
  bridges: readonly string[] = FACTS.bridges_mm.flatMap(() => FACTS.bridges.map(() => ""));
  cureFit: CureFit | null = null;
  /** The resin that the bridges were printed with. */
  #bridgesResin: Resin | null = null;

  /** State of the test towers for the printer. */
  get towers(): TowersState {
    if (this.busy?.task === "towers") return "writing";
    return this.busy === null && this.options !== null ? "ready" : "waiting";
  }

  /** Starts the worker and fetches the list of printers, once. */
  override start(): void {
    if (this.#isStarted) return;
    this.#isStarted = true;
    this.slicer.warm();
    // The next call reports a worker that does not start.
    void this.slicer.printers().then(
      (printers) => {
        this.printers = printers;
        this.host.offered?.();
        this.changed();
      },
      () => (this.#isStarted = false),
    );
  }

  /** Returns true if a change of settings waits for its delay before planning. */
  get isPending(): boolean {
    return this.#timer !== undefined;
  }

  /** Returns true if the result belongs to earlier settings because the current ones have no plan. */
  get earlier(): boolean {
    return this.result !== null && this.busy === null && (Object.keys(this.faults).length > 0 || this.#failed);
  }

  /** Tolerance that the core chose for the current metric by default; null if unknown. */
  get taken(): number | null {
    const { result, settings } = this;
    return result?.report.metric === settings.metric && result.options.tolerance === undefined ? result.report.tolerance : null;
  }

  /** Turns the model: previews it during the turn, and plans on release. */
  turn(rotation: Rotation, isFinal: boolean): void {
    if (!isFinal) return this.#preview.turn(rotation, this.options);
    this.#preview.stop();
    const text = rotationText(rotation);
    // A turn back has its own kind, so that the turn stays an undo step.
    this.change({ rotation: text }, text === "" ? "turn back" : "turn");
  }

  /** Applies a candidate of {@link orientation}: its pose, or a change that contains it. */
  orient(candidate: Candidate, change = withPose(this.settings, candidate)): void {
    this.#preview.stop();
    this.change(change);
    if (this.options !== null) this.orientation.applied(this.options);
    this.host.oriented?.(candidate);
  }

  /** Turns the model to its best direction, supports it, and hollows it if it takes much resin: one step back. False if nothing was found. */
  async prepare(): Promise<boolean> {
    const { model, orientation } = this;
    if (model === null || orientation.busy !== null) return false;
    if (!orientation.isCurrent || orientation.best.length === 0) await orientation.start();
    const [best] = orientation.best;
    if (best === undefined || this.model !== model) return false;
    this.orient(best, prepared(this.settings, best, this.result?.own?.resin_ml ?? 0));
    return true;
  }

  protected override painted(isFinal: boolean): void {
    const { options } = this;
    if (!isFinal) {
      if (options !== null) void this.#preview.follow(options);
      return;
    }
    this.#preview.stop();
    this.#curve.forget();
    this.replan();
  }

  /** Applies the tolerance of a point of the curve, as if typed. */
  takePoint(index: number): void {
    const point = this.curve?.[index];
    if (point !== undefined) this.change(withPoint(this.settings, point));
  }

  /** Quality from 0, the fastest print worth having, to 1, the finest; applied at once, or once the curve is known. */
  set quality(quality: number | null) {
    this.#curve.wanted = quality;
    this.#takeQuality();
  }

  get quality(): number | null {
    const { wanted } = this.#curve;
    return wanted ?? (this.result === null ? null : this.#curve.placeOf(this.result.report));
  }

  /** Returns true if the result is for the current settings and weights. */
  get isCurrent(): boolean {
    return this.result !== null && areSame(this.result.options, this.options) && this.#weightsOf === this.weights;
  }

  /** Returns true if planning with the current settings may succeed: they are valid, and the core has not refused them. */
  get canPlan(): boolean {
    const { options, weights } = this;
    return options !== null && !(areSame(this.#refused?.options ?? null, options) && this.#refused?.weights === weights);
  }

  override replan(delay_ms = 0): void {
    this.#forgetTimer();
    this.changed();
    const { options } = this;
    if (options === null || this.model === null) return;
    if (delay_ms === 0) return void this.#plan(options);
    this.#timer = setTimeout(() => {
      this.#timer = undefined;
      void this.#plan(options);
    }, delay_ms);
  }

  /** Stops the running task at any stage. The last good result stays. */
  cancel(): void {
    if (this.busy === null) return;
    const { task } = this.busy;
    this.drop();
    this.notice = task === "export" || task === "towers" ? "exportCancelled" : "cancelled";
    this.host.cancelled?.();
    this.changed();
    void this.#background.fetch();
  }

  /** Makes the print file of the result; null if there is no result, a task runs, or the file failed or was cancelled. */
  async export(): Promise<PrintFile | null> {
    const { result } = this;
    if (result === null || this.busy !== null) return null;
    if (this.#archive?.of === result) return this.#archive.file;
    const file = await this.write("export", (watch) => this.plate.export(watch));
    if (file !== null) this.#archive = { of: result, file };
    return file;
  }

  /** Makes the print file of a plate; null as in {@link export}. */
  async exportPlate(plate: number): Promise<PrintFile | null> {
    if (this.result === null || this.busy !== null) return null;
    return this.write("export", (watch) => this.plate.export(watch, plate));
  }

  /** Makes the print file of test towers for the printer; null if currently impossible, failed or cancelled. */
  async calibrateLayers(): Promise<PrintFile | null> {
    const { options, towers } = this;
    if (options === null || towers !== "ready") return null;
    return this.write("towers", (watch) => this.slicer.calibrateLayers(options, watch));
  }

  /** Makes the print file of the bridges that measure print-through; null as with towers. */
  async calibrateCure(): Promise<PrintFile | null> {
    const { options, towers } = this;
    if (options === null || towers !== "ready") return null;
    this.#bridgesResin = options.resin ?? {};
    return this.write("towers", (watch) => this.slicer.calibrateCure(options, watch));
  }

  /** Sets the print-through of the resin by measured thicknesses of the bridges. */
  async measureBridges(bridges: readonly string[]): Promise<void> {
    this.bridges = bridges;
    this.changed();
    // The bridges were printed before any fit.
    this.#bridgesResin ??= this.options?.resin ?? {};
    const measured_mm = bridges.map((text) => read(text, "mm").value ?? Number.NaN);
    const cureFit = await this.slicer.fitCure(measured_mm, this.#bridgesResin).catch(() => null);
    // Another thickness was typed in the meantime.
    if (this.bridges !== bridges) return;
    this.cureFit = cureFit;
    if (cureFit === null) return this.changed();
    const { penetration_mm, print_through: { overcure_mm, retained } } = cureFit;
    this.change({ penetration: penetration_mm.toFixed(3), overcure: overcure_mm.toFixed(3), retained: (retained ?? 1).toFixed(2) });
  }

  selectLayer(layer: number): void {
    if (this.result === null) return;
    this.layer = Math.min(Math.max(0, Math.round(layer)), this.result.report.layers - 1);
    this.changed();
    void this.#background.fetch();
  }

  protected override preferred(delay_ms: number): void {
    this.failure = null;
    this.notice = null;
    this.host.settingsChanged?.(this.settings);
    this.replan(delay_ms);
  }

  protected override left(isNew: boolean): void {
    this.#preview.stop();
    this.orientation.forget();
    if (!isNew) return;
    this.#next = null;
    this.result = null;
    this.#refused = null;
    this.shown = null;
    this.#background.mask = this.#background.price = null;
    this.#curve.forget();
    this.checks.forget();
  }

  async #plan(options: Options): Promise<void> {
    const { model } = this;
    if (model === null) return;
    const { task } = this.runner;
    if (task !== null) {
      if (areSame(task.options, options) && task.weights === this.weights) {
        this.#next = null;
        return;
      }
      // A plan with other rays is obsolete. Any other task may end first: a plan with the same rays is nearly done, and the next one reuses
      // its samples.
      if (task.options === null || sameRays(task.options, options)) {
        this.#next = options;
        return;
      }
      this.drop();
    }
    this.failure = null;
    this.#failed = true;
    const { weights } = this;
    this.keepPose();
    const plan = await this.run("plan", model.name, options, (watch) => this.plate.plan(options, watch));
    if (plan !== null) this.#show(plan, options, weights);
    else this.#refuse(options, weights);
    await this.resume();
  }

  protected override replate(): void {
    this.drop();
    this.#refused = null;
    this.#curve.forget();
    this.failure = null;
    this.notice = null;
    this.replan();
  }

  protected override showPlate(plan: Plan): void {
    const { result } = this;
    if (result === null) return;
    this.#archive = null;
    this.#background.mask = null;
    this.#curve.forget();
    this.#show(plan, result.options, this.#weightsOf);
    void this.#background.fetch();
  }

  /** Records a refused plan; a cancelled one may succeed later. */
  #refuse(options: Options, weights: Float32Array | null): void {
    const { failure } = this;
    if (failure?.task !== "plan" || BY_CHANCE.has(failure.error.code)) return;
    this.#refused = { options, weights };
    this.changed();
  }

  /** Plans with the settings that changed during the last task, if any; otherwise fetches the mask and the curve. */
  protected override async resume(): Promise<void> {
    const next = this.#next;
    if (this.runner.task !== null) return;
    if (next === null) return this.#background.fetch();
    this.#next = null;
    await this.#plan(next);
  }

  #show(plan: Plan, options: Options, weights: Float32Array | null): void {
    const { report } = plan;
    this.#failed = false;
    const before = this.result?.report;
    const z = before?.z_mm[this.layer];
    const { isSeveral, selected } = this.plate;
    const models = plan.plates.flatMap(({ report }) => report.models);
    const own = models.find(({ model }) => model === selected);
    const result = { ...plan, options, own, limits: report.layer_range_mm };
    this.result = result;
    this.#weightsOf = weights;
    // On a plate, each copy has its own supports.
    this.shown = shownOf(report, plan.profile, { supports: isSeveral ? undefined : plan.supports?.[selected], voids: plan.voids?.[selected] });
    // Keeps the height of the selected layer; starts in the middle of a new model.
    this.layer = layerAt(report.z_mm, z === undefined ? report.height_mm / 2 : (z * report.height_mm) / (before?.height_mm ?? 1));
    if (before === undefined && this.notice === "cancelled") this.notice = null;
    if (before === undefined) this.#background.mask = null;
    this.#curve.fit(result);
    this.host.planned?.(result);
    this.changed();
    void this.orientation.measure();
  }

  /** Makes a file, then continues waiting work; null if it failed or was cancelled. */
  async write<Made extends Download>(kind: Busy["task"], call: (watch: Watch) => Promise<Made>): Promise<Made | null> {
    this.failure = null;
    const file = await this.run(kind, this.model?.name ?? "", null, call);
    void this.resume();
    return file;
  }

  #forgetTimer(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
  }

  protected override drop(): void {
    this.#forgetTimer();
    this.#next = null;
    this.runner.drop();
  }

  #takeQuality(): void {
    const index = this.#curve.takeWanted();
    const point = index === null ? undefined : this.curve?.[index];
    if (point !== undefined) this.preset(withPoint(this.settings, point));
  }
}
