/** What the user wants: the settings, with the steps to undo, and the printers and resins to choose from. */
import type { Backend, GpuMethod, KnownPrinter, Options, Resin } from "../../api/wire.js";
import { History } from "./history.js";
import { isEqual } from "./plain.js";
import type { PlateState } from "./plate.js";
import { changed, check, type Faults, type Offered, type Settings } from "./settings.js";

/** Pause after the last keystroke before the settings are planned. */
const DEBOUNCE_MS = 250;

/** What undo goes back to: the settings, and the models with their copies and places. */
interface Step {
  readonly settings: Settings;
  readonly plate: PlateState;
}

export abstract class Preferences implements Offered {
  settings: Settings;
  /** The backend of every plan; null leaves the choice to the core. */
  backend: Backend | null;
  /** How a GPU samples; null leaves the choice to the core. */
  gpuMethod: GpuMethod | null = null;
  printers: readonly KnownPrinter[] = [];
  resins: readonly Resin[] = [];
  /** Settings that only the page may change. */
  fixed: ReadonlySet<keyof Settings> = new Set();
  readonly #history = new History<Step>();

  constructor(settings: Settings, backend: Backend | null) {
    this.settings = { ...settings };
    this.backend = backend;
  }

  /** Called when the settings have changed: they are to be planned after this time, unless they change again. */
  protected abstract preferred(delay_ms: number): void;

  /** The models as they are. */
  protected abstract standing(): PlateState;

  /** Brings the models back to a state, in the pose of the settings, and plans them. False if that is how they are. */
  protected abstract stand(state: PlateState): boolean;

  get faults(): Faults {
    const checked = check(this.settings, this);
    return checked.ok ? {} : checked.faults;
  }

  /** The options that the settings give; null if a setting is invalid. */
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

  /** Applies settings from the page, including fixed ones, without an undo step. Those that it has change nothing. */
  preset(patch: Partial<Settings>): void {
    this.#take(changed(this.settings, patch));
  }

  /** Replaces all settings except fixed ones, as from a URL, without an undo step. */
  restore(settings: Settings): void {
    this.#take(this.#allowed(settings));
  }

  /**
   * Changes settings, except fixed ones, as an undo step, and plans again after a pause if they are valid. Quick changes of
   * one `kind` are a single step.
   */
  change(patch: Partial<Settings>, kind = Object.keys(patch).join()): void {
    this.note(kind);
    this.#set(this.#allowed(changed(this.settings, patch)));
  }

  /** Makes an undo step of the change that follows. */
  protected note(kind: string): void {
    this.#history.note(this.#now(), kind, performance.now());
  }

  undo(): void {
    if (this.canUndo) this.#go(this.#history.undo(this.#now()));
  }

  redo(): void {
    if (this.canRedo) this.#go(this.#history.redo(this.#now()));
  }

  /** Forgets the steps that only changed models which are no longer there. */
  protected forgetModels(): void {
    this.#history.forget((before, after) => before.settings === after.settings, this.#now());
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
