/** What a person wants: the settings, what there is to choose from, and the way back to what they were. */
import type { Backend, Options, Printer, Resin } from "../../api/wire.js";
import { History } from "./history.js";
import { check, type Faults, type Offered, type Settings } from "./settings.js";

/** Pause after the last keystroke before anything is made of it. */
const DEBOUNCE_MS = 250;

export abstract class Preferences implements Offered {
  settings: Settings;
  /** Asked for in every plan; null leaves the choice to the core. */
  backend: Backend | null;
  printers: readonly Printer[] = [];
  resins: readonly Resin[] = [];
  /** Settings that the page alone decides. */
  fixed: ReadonlySet<keyof Settings> = new Set();
  readonly #history = new History<Settings>();

  constructor(settings: Settings, backend: Backend | null) {
    this.settings = { ...settings };
    this.backend = backend;
  }

  /** Other settings hold from now on; they are worth a plan after this time, unless others come. */
  protected abstract preferred(delay_ms: number): void;

  get faults(): Faults {
    const checked = check(this.settings, this);
    return checked.ok ? {} : checked.faults;
  }

  /** What the settings ask for; null where they make no sense. */
  get options(): Options | null {
    const checked = check(this.settings, this);
    if (!checked.ok) return null;
    return this.backend === null ? checked.options : { ...checked.options, backend: this.backend };
  }

  get canUndo(): boolean {
    return this.#history.canUndo;
  }

  get canRedo(): boolean {
    return this.#history.canRedo;
  }

  /** Takes settings that the page decides, fixed ones too: there is no step back from them. */
  preset(patch: Partial<Settings>): void {
    this.#set({ ...this.settings, ...patch }, DEBOUNCE_MS);
  }

  /** Takes all settings at once, as an address has them. */
  restore(settings: Settings): void {
    this.#set(this.#allowed(settings), DEBOUNCE_MS);
  }

  /** Changes settings and plans again, soon if they make sense. */
  change(patch: Partial<Settings>): void {
    this.#history.note(this.settings, Object.keys(patch).join(), performance.now());
    this.#set(this.#allowed({ ...this.settings, ...patch }), DEBOUNCE_MS);
  }

  undo(): void {
    const before = this.#history.undo(this.settings);
    if (before !== null) this.#set(this.#allowed(before), 0);
  }

  redo(): void {
    const after = this.#history.redo(this.settings);
    if (after !== null) this.#set(this.#allowed(after), 0);
  }

  /** These settings with the fixed ones as they are. */
  #allowed(settings: Settings): Settings {
    const kept = Object.fromEntries([...this.fixed].map((key) => [key, this.settings[key]]));
    return { ...settings, ...kept };
  }

  #set(settings: Settings, delay_ms: number): void {
    this.settings = settings;
    this.preferred(delay_ms);
  }
}
