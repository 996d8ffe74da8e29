/** Findings on each new plan, checked in the background if a panel, a shop or the page asks for them. */
import { FACTS } from "../../api/facts.js";
import { isAbort, SlicerError } from "../../api/error.js";
import type { Check, Slicer } from "../../api/index.js";
import type { Finding, Limits } from "../../api/wire.js";
import { isEqual } from "./plain.js";
import { checkedOf, onCopies, outlinesOf, pullOf, type Checked, type Outline } from "./checked.js";
import type { Result } from "./result.js";

export interface ChecksHost {
  /** The plan shown; null without one. */
  readonly result: Result | null;
  changed(): void;
  /** Called when a check should run now. */
  wanted(): void;
  checked(check: Check): void;
  unchecked(error: SlicerError): void;
  /** Called when a finding is chosen, with its first layer. */
  look(layer: number): void;
}

/** Input of a check. */
interface Subject {
  readonly result: Result;
  readonly limits: Limits | null;
}

const NO_MARKS: readonly Outline[] = [];
const NO_PULLS: readonly number[] = [];

export class Checks {
  /** The last check, possibly of an earlier plan. */
  last: Check | null = null;
  /** Models of that check, with their findings. */
  models: readonly Checked[] = [];
  readonly #host: ChecksHost;
  readonly #slicer: Pick<Slicer, "check">;
  #limits: Limits | null = null;
  #isOpen = false;
  #chosen: Finding | null = null;
  #marks = NO_MARKS;
  /** Computed when first shown. */
  #outlines: readonly Outline[] | null = null;
  #pull_n: readonly number[] | null = null;
  #showsWalls = false;
  #error: SlicerError | null = null;
  /** Input of the last check or of its failure. */
  #of: Subject | null = null;

  constructor(host: ChecksHost, slicer: Pick<Slicer, "check">) {
    this.#host = host;
    this.#slicer = slicer;
  }

  /** A shop's acceptance limits. With limits, every plan is checked; without, only while a panel shows the findings. */
  get limits(): Limits | null {
    return this.#limits;
  }
  set limits(limits: Limits | null) {
    if (isEqual(limits, this.#limits)) return;
    this.#limits = limits;
    this.#host.changed();
    this.#host.wanted();
  }

  /** Returns true if a panel shows the findings. */
  get isOpen(): boolean {
    return this.#isOpen;
  }
  set isOpen(isOpen: boolean) {
    if (isOpen === this.#isOpen) return;
    this.#isOpen = isOpen;
    // Retries code that could not be loaded.
    if (isOpen && this.#error?.code === "part-failed") this.#of = null;
    this.#host.changed();
    if (isOpen) this.#host.wanted();
  }

  /** True to check each plan once nothing else is to be done. */
  isWatching = false;

  /** Returns true if the view shows wall thickness, on which no check depends. */
  get showsWalls(): boolean {
    return this.#showsWalls;
  }
  set showsWalls(isOn: boolean) {
    this.#showsWalls = isOn;
    this.#host.changed();
  }

  /** Walls thinner than this are thin, mm. */
  get wall_mm(): number {
    return this.#limits?.wall_mm ?? FACTS.limits.wall_mm;
  }

  /** Returns true if the last check or its failure is that of the plan shown. */
  get isCurrent(): boolean {
    return this.#of !== null && this.#isNow(this.#of);
  }

  /** The check of the plan shown; null until known. */
  get check(): Check | null {
    return this.isCurrent && this.#error === null ? this.last : null;
  }

  /** Error of the check of the plan shown; null if it succeeded or has not run yet. */
  get error(): SlicerError | null {
    return this.isCurrent ? this.#error : null;
  }

  /** The chosen finding, even if no panel shows it any more; null if the plan has changed. */
  get chosen(): Finding | null {
    return this.check === null ? null : this.#chosen;
  }

  /** The chosen finding on each copy with the same turn; empty without one. */
  get marks(): readonly Outline[] {
    return this.chosen === null ? NO_MARKS : this.#marks;
  }

  /** Findings of the current check that need attention, on each copy. */
  get outlines(): readonly Outline[] {
    return this.check === null ? NO_MARKS : (this.#outlines ??= outlinesOf(this.models));
  }

  /** The same; empty unless a panel shows the findings. */
  get places(): readonly Outline[] {
    return this.#isOpen ? this.outlines : NO_MARKS;
  }

  /** Pull of the film at each layer of the plate shown, N; empty until checked. */
  get pull_n(): readonly number[] {
    return this.check === null ? NO_PULLS : (this.#pull_n ??= pullOf(this.models));
  }

  /** Chooses a finding of the current check and shows its first layer. The finding already chosen, or null, clears the choice. */
  choose(finding: Finding | null): void {
    this.#chosen = finding === this.chosen ? null : finding;
    this.#marks = this.#chosen === null ? NO_MARKS : onCopies(this.#chosen, this.models);
    if (this.chosen === null) this.#host.changed();
    else this.#host.look(this.chosen.layers[0]);
  }

  /**
   * Checks a plan; returns false if not needed.
   *
   * @param isWatched true to check a plan for which no panel and no shop asks
   */
  async fetch(result: Result, isWatched = false): Promise<boolean> {
    const limits = this.#limits;
    const of = { result, limits };
    if (!(this.#isOpen || limits !== null || isWatched) || this.isCurrent) return false;
    const { plate } = result.report;
    try {
      const check = await this.#slicer.check(limits ?? {}, { plate });
      if (!this.#isNow(of)) return true;
      this.#keep(of, check, null);
      this.#host.checked(check);
    } catch (error) {
      if (isAbort(error) || !(error instanceof SlicerError)) throw error;
      if (!this.#isNow(of)) return true;
      this.#keep(of, null, error);
      this.#host.unchecked(error);
    }
    this.#host.changed();
    return true;
  }

  /** Forgets everything, as when another model is opened. */
  forget(): void {
    this.last = this.#chosen = this.#error = this.#of = null;
    this.models = [];
  }

  #isNow({ result, limits }: Subject): boolean {
    return result === this.#host.result && limits === this.#limits;
  }

  #keep(of: Subject, check: Check | null, error: SlicerError | null): void {
    this.#of = of;
    this.last = check;
    this.models = check === null ? [] : checkedOf(check, of.result.report);
    this.#outlines = this.#pull_n = null;
    this.#error = error;
    this.#chosen = null;
  }
}
