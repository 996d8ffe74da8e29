/** What the user wants: the settings, with their undo steps, and the printers and resins to choose from. */
import type { Backend, GpuMethod, KnownPrinter, Options, Resin } from "../../api/wire.js";
import { History } from "./history.js";
import { readPrinter } from "./printer.js";
import { check, type Faults, type Offered, type Settings } from "./settings.js";

/** Pause after the last keystroke before the settings are planned. */
const DEBOUNCE_MS = 250;

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
  #history = new History<Settings>();

  constructor(settings: Settings, backend: Backend | null) {
    this.settings = { ...settings };
    this.backend = backend;
  }

  /** Called when the settings have changed: they are to be planned after this time, unless they change again. */
  protected abstract preferred(delay_ms: number): void;

  /** Called when a file cannot be read, with its name: a failure to show. */
  protected abstract refused(error: unknown, name: string): void;

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

  /** Applies settings from the page, including fixed ones, without an undo step. */
  preset(patch: Partial<Settings>): void {
    this.#set({ ...this.settings, ...patch }, DEBOUNCE_MS);
  }

  /** Replaces all settings except fixed ones, as from a URL, without an undo step. */
  restore(settings: Settings): void {
    this.#set(this.#allowed(settings), DEBOUNCE_MS);
  }

  /**
   * Changes settings, except fixed ones, as an undo step, and plans again after a pause if they are valid. Quick changes of
   * one `kind` are a single step.
   */
  change(patch: Partial<Settings>, kind = Object.keys(patch).join()): void {
    this.#history.note(this.settings, kind, performance.now());
    this.#set(this.#allowed({ ...this.settings, ...patch }), DEBOUNCE_MS);
  }

  /** Chooses the printer that a file describes. */
  async openPrinter(file: File): Promise<void> {
    try {
      this.change({ printer: await readPrinter(file) });
    } catch (error) {
      this.refused(error, file.name);
    }
  }

  undo(): void {
    const before = this.#history.undo(this.settings);
    if (before !== null) this.#set(this.#allowed(before), 0);
  }

  redo(): void {
    const after = this.#history.redo(this.settings);
    if (after !== null) this.#set(this.#allowed(after), 0);
  }

  /** Sets what belongs to another model; the steps of the one before do not apply to it. */
  protected swap(patch: Partial<Settings>): void {
    this.#history = new History<Settings>();
    this.settings = { ...this.settings, ...patch };
  }

  /** These settings, with the fixed ones unchanged. */
  #allowed(settings: Settings): Settings {
    const kept = Object.fromEntries([...this.fixed].map((key) => [key, this.settings[key]]));
    return { ...settings, ...kept };
  }

  #set(settings: Settings, delay_ms: number): void {
    this.settings = settings;
    this.preferred(delay_ms);
  }
}
