/** User's choices: settings with undo steps, and the printers and resins on offer. */
import type { Backend, GpuMethod, KnownPrinter, Options, Resin } from "../../api/wire.js";
import { History } from "./history.js";
import { isEqual } from "./plain.js";
import type { PlateState } from "./plate.js";
import { changed, check, type Faults, type Offered, type Settings } from "./settings.js";

/** Delay after the last keystroke before planning. */
const DEBOUNCE_MS = 250;

/** An undo step: settings, and models with copies and placements. */
interface Step {
  readonly settings: Settings;
  readonly plate: PlateState;
}

export abstract class Preferences implements Offered {
  settings: Settings;
  /** Backend for every plan; null: chosen by the core. */
  backend: Backend | null;
  /** GPU method; null: chosen by the core. */
  gpuMethod: GpuMethod | null = null;
  printers: readonly KnownPrinter[] = [];
  resins: readonly Resin[] = [];
  recent: readonly string[] = [];
  /** Settings that only the page may change. */
  fixed: ReadonlySet<keyof Settings> = new Set();
  readonly #history = new History<Step>();

  constructor(settings: Settings, backend: Backend | null) {
    this.settings = { ...settings };
    this.backend = backend;
  }

  /** Called when the settings have changed: plan after this delay, unless they change again. */
  protected abstract preferred(delay_ms: number): void;

  /** Current state of the models. */
  protected abstract standing(): PlateState;

  /** Restores the models, in the pose of the settings, and plans them. Returns false if nothing changes. */
  protected abstract stand(state: PlateState): boolean;

  get faults(): Faults {
    const checked = check(this.settings, this);
    return checked.ok ? {} : checked.faults;
  }

  /** Options of the settings; null if a setting is invalid. */
  get options(): Options | null {
    const checked = check(this.settings, this);
    if (!checked.ok) return null;
    return {
      ...checked.options,
      ...(this.backend !== null && { backend: this.backend }),
      ...(this.gpuMethod !== null && { gpu_method: this.gpuMethod }),
    };
  }

  get canUndo(): boolean {
    return this.#history.canUndo;
  }

  get canRedo(): boolean {
    return this.#history.canRedo;
  }

  /** Applies settings from the page, including fixed ones, without an undo step. Unchanged values have no effect. */
  preset(patch: Partial<Settings>): void {
    this.#take(changed(this.settings, patch));
  }

  /** Replaces all settings except fixed ones, as from a URL, without an undo step. */
  restore(settings: Settings): void {
    this.#take(this.#allowed(settings));
  }

  /**
   * Changes settings, except fixed ones, as an undo step, and plans after a delay if they are valid. Quick changes of one `kind` form a
   * single step.
   */
  change(patch: Partial<Settings>, kind = Object.keys(patch).join()): void {
    this.note(kind);
    this.#set(this.#allowed(changed(this.settings, patch)));
  }

  /** Records an undo step for the next change. */
  protected note(kind: string): void {
    this.#history.note(this.#now(), kind, performance.now());
  }

  undo(): void {
    if (this.canUndo) this.#go(this.#history.undo(this.#now()));
  }

  redo(): void {
    if (this.canRedo) this.#go(this.#history.redo(this.#now()));
  }

  #now(): Step {
    return { settings: this.settings, plate: this.standing() };
  }

  #go(step: Step | null): void {
    if (step === null) return;
    this.settings = this.#allowed(step.settings);
    if (!this.stand(step.plate)) this.preferred(0);
  }

  /** These settings, with the fixed ones unchanged. */
  #allowed(settings: Settings): Settings {
    const kept = Object.fromEntries([...this.fixed].map((key) => [key, this.settings[key]]));
    return { ...settings, ...kept };
  }

  #take(settings: Settings): void {
    if (!isEqual(settings, this.settings)) this.#set(settings);
  }

  #set(settings: Settings): void {
    this.settings = settings;
    this.preferred(DEBOUNCE_MS);
  }
}
