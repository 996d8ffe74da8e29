/**
 * What the page is doing: one model, its settings, the last good result, and at most one task at a time.
 *
 * No DOM here: an element (or a test) hosts it, is told when something changed, and draws what it finds.
 */
import { archiveName, choose } from "./choice.js";
import { layerAt } from "./layers.js";
import { explain, notAnStl, type Problem } from "./problem.js";
import { check, DEFAULT_SETTINGS, layerRange, sameRays, type Faults, type Settings } from "./settings.js";
import { isAbort, SlicerError, type SlicerClient, type Watch } from "../api/slicer.js";
import type { Backend, MeshInfo, Options, Plan, Stage } from "../api/wire.js";

export interface Model {
  name: string;
  info: MeshInfo;
}

export interface Busy {
  task: "open" | "plan" | "archive";
  name: string;
  stage: Stage;
  fraction: number;
}

/** A plan with the options it was made for. */
export interface Result extends Plan {
  options: Options;
  /** Thinnest and thickest layer allowed, mm: the ends of the colour scale. */
  limits: readonly [number, number];
}

export interface Mask {
  layer: number;
  width: number;
  height: number;
  bits: Uint8Array;
}

export interface Download {
  name: string;
  blob: Blob;
}

export interface Host {
  requestUpdate(): void;
}

type Client = Pick<SlicerClient, "open" | "plan" | "mask" | "archive" | "warm">;

/** Pause after the last keystroke before planning anew. */
const DEBOUNCE_MS = 250;

export class Session {
  model: Model | null = null;
  settings: Settings;
  faults: Faults = {};
  result: Result | null = null;
  busy: Busy | null = null;
  problem: Problem | null = null;
  /** Something worth saying that is no failure. */
  notice: string | null = null;
  /** The layer looked at, from 0. */
  layer = 0;
  mask: Mask | null = null;

  readonly #host: Host;
  readonly #client: Client;
  readonly #backend: Backend | null;
  /** What runs. `options` are those of a plan, and null for anything else. */
  #task: { abort: AbortController; options: Options | null } | null = null;
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Options to plan with when the task under way has ended. */
  #next: Options | null = null;
  #maskRunning = false;
  #maskOf: Result | null = null;
  /** Whether the newest plan asked for has not come about. */
  #failed = false;
  #archive: { of: Result; blob: Blob } | null = null;

  /** `backend` is asked for in every plan; null leaves the choice to the core. */
  constructor(host: Host, client: Client, settings: Settings = DEFAULT_SETTINGS, backend: Backend | null = null) {
    this.settings = { ...settings };
    this.#host = host;
    this.#client = client;
    this.#backend = backend;
    client.warm();
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

  /** Takes the first STL of a drop or a dialogue. */
  async choose(files: readonly File[]): Promise<void> {
    const choice = choose(files);
    if (choice.kind === "none") return;
    if (choice.kind === "not-stl") {
      this.problem = notAnStl(choice.name);
      this.#changed();
      return;
    }
    await this.open(choice.file, choice.file.name, choice.notice);
  }

  async open(file: Blob, name: string, notice: string | null = null): Promise<void> {
    this.#drop();
    this.notice = notice;
    this.problem = null;
    const info = await this.#run("open", name, null, (watch) => this.#client.open(file, watch));
    if (info === null) return this.#resume();
    this.#next = null;
    this.model = { name, info };
    this.result = null;
    this.mask = null;
    this.replan();
  }

  /** Changes settings and plans again, soon if they make sense. */
  change(patch: Partial<Settings>): void {
    this.settings = { ...this.settings, ...patch };
    this.problem = null;
    this.notice = null;
    this.replan(DEBOUNCE_MS);
  }

  replan(delay_ms = 0): void {
    clearTimeout(this.#timer);
    const checked = check(this.settings);
    this.faults = checked.ok ? {} : checked.faults;
    this.#changed();
    if (!checked.ok || this.model === null) return;
    const options = this.#backend === null ? checked.options : { ...checked.options, backend: this.#backend };
    if (delay_ms === 0) void this.#plan(options);
    else this.#timer = setTimeout(() => void this.#plan(options), delay_ms);
  }

  /** Stops the task under way, whatever stage it is in. The last good result stays. */
  cancel(): void {
    if (this.busy === null) return;
    const { task } = this.busy;
    this.#drop();
    this.notice = task === "archive" ? "The download was cancelled." : "Cancelled.";
    this.#changed();
    void this.#refreshMask();
  }

  /** Makes the zip of the result on show; null if cancelled or failed. */
  async download(): Promise<Download | null> {
    const { result, model } = this;
    if (result === null || model === null || this.busy !== null) return null;
    const name = archiveName(model.name);
    if (this.#archive?.of === result) return { name, blob: this.#archive.blob };
    this.problem = null;
    const zip = await this.#run("archive", model.name, null, (watch) => this.#client.archive(watch));
    void this.#resume();
    if (zip === null) return null;
    // The bytes come from a transfer, so they are never shared memory.
    const blob = new Blob([zip as Uint8Array<ArrayBuffer>], { type: "application/zip" });
    this.#archive = { of: result, blob };
    return { name, blob };
  }

  look(layer: number): void {
    if (this.result === null) return;
    this.layer = Math.min(Math.max(0, Math.round(layer)), this.result.report.layers - 1);
    this.#changed();
    void this.#refreshMask();
  }

  dismiss(): void {
    this.problem = null;
    this.notice = null;
    this.#changed();
  }

  async #plan(options: Options): Promise<void> {
    const { model } = this;
    if (model === null) return;
    if (this.#task !== null) {
      // A plan through other rays is not worth its time any more. Anything else may end first: a plan over the same
      // rays is nearly there, and what it has sampled serves the next one.
      if (this.#task.options === null || sameRays(this.#task.options, options)) {
        this.#next = options;
        return;
      }
      this.#drop();
    }
    this.problem = null;
    this.#failed = true;
    const plan = await this.#run("plan", model.name, options, (watch) => this.#client.plan(options, watch));
    if (plan !== null) this.#show(plan, options);
    await this.#resume();
  }

  /** Plans with the settings that came while something else was under way. */
  async #resume(): Promise<void> {
    const next = this.#next;
    if (next === null || this.#task !== null) return;
    this.#next = null;
    await this.#plan(next);
  }

  #show(plan: Plan, options: Options): void {
    const { report } = plan;
    this.#failed = false;
    const before = this.result?.report;
    const z = before?.z_mm[this.layer];
    this.result = { ...plan, options, limits: layerRange(options) };
    // Keep looking at the same height, or at the middle of a new model.
    this.layer = layerAt(report.z_mm, z === undefined ? report.height_mm / 2 : (z * report.height_mm) / (before?.height_mm ?? 1));
    if (before === undefined) this.notice = this.notice?.includes("Cancelled") ? null : this.notice;
    this.mask = before === undefined ? null : this.mask;
    this.#changed();
    void this.#refreshMask();
  }

  /** Runs one task, with progress shown. Null if it was cancelled or failed; a failure is shown. */
  async #run<T>(task: Busy["task"], name: string, options: Options | null, call: (watch: Watch) => Promise<T>): Promise<T | null> {
    const mine = { abort: new AbortController(), options };
    const { settings } = this;
    this.#task = mine;
    this.busy = { task, name, stage: task === "archive" ? "masks" : "load", fraction: 0 };
    this.#changed();
    const progress: Watch["progress"] = (stage, fraction) => {
      if (this.#task !== mine) return;
      this.busy = { task, name, stage, fraction };
      this.#changed();
    };
    try {
      const value = await call({ signal: mine.abort.signal, progress });
      // Something else may have begun while the answer was on its way.
      return this.#task === mine ? value : null;
    } catch (error) {
      if (this.#task === mine && !isAbort(error)) this.problem = explain(asSlicerError(error), name, settings);
      return null;
    } finally {
      if (this.#task === mine) {
        this.#task = null;
        this.busy = null;
        this.#changed();
      }
    }
  }

  /** Abandons whatever is under way or waiting. */
  #drop(): void {
    clearTimeout(this.#timer);
    this.#next = null;
    const task = this.#task;
    this.#task = null;
    this.busy = null;
    task?.abort.abort();
  }

  /** Fetches the mask of the layer looked at. One call at a time; the newest layer wins. */
  async #refreshMask(): Promise<void> {
    if (this.#maskRunning) return;
    this.#maskRunning = true;
    try {
      // While a task runs the worker would not answer, and when it ends this is called again.
      while (this.result !== null && this.#task === null && !this.#hasMask()) {
        const { result, layer } = this;
        const bits = await this.#client.mask(layer);
        if (this.result !== result) continue;
        const { width, height } = result.report.mask;
        this.mask = { layer, width, height, bits };
        this.#maskOf = result;
        this.#changed();
      }
    } catch (error) {
      if (this.#task === null && this.model !== null && !isAbort(error)) {
        this.problem = explain(asSlicerError(error), this.model.name, this.settings);
        this.#changed();
      }
    } finally {
      this.#maskRunning = false;
    }
  }

  #hasMask(): boolean {
    return this.mask?.layer === this.layer && this.#maskOf === this.result;
  }

  #changed(): void {
    this.#host.requestUpdate();
  }
}

function asSlicerError(error: unknown): SlicerError {
  if (error instanceof SlicerError) return error;
  return new SlicerError({ code: "crash", message: error instanceof Error ? error.message : String(error), detail: null });
}
