/** Price and verdict of the current plan, updated with the plan and the number of copies. */
import { isAbort, type Check, type Price } from "cusp-slicer";
import type { CuspSlicer } from "cusp-slicer/element-class";
import { LIMITS, pricesOf, PRINTERS, RESINS } from "../catalogue.js";

export type Result = NonNullable<CuspSlicer["result"]>;

export class Assessment {
  readonly #slicer: CuspSlicer;
  readonly #changed: () => void;
  #priced: { of: Result; copies: number; price: Price } | null = null;
  #checked: { of: Result; check: Check } | null = null;
  /** The last check requested, so that each plan is checked once. */
  #asked: { of: Result; done: Promise<void> } | null = null;
  /** The plan whose price or check failed. */
  #failed: Result | null = null;

  constructor(slicer: CuspSlicer, changed: () => void) {
    this.#slicer = slicer;
    this.#changed = changed;
  }

  /** Price of `copies` of a plan; null until known. */
  price(of: Result, copies: number): Price | null {
    return this.#priced?.of === of && this.#priced.copies === copies ? this.#priced.price : null;
  }

  /** Check of a plan; null until known. */
  check(of: Result): Check | null {
    return this.#checked?.of === of ? this.#checked.check : null;
  }

  /** Returns true if the price or check of a plan failed. */
  hasFailed(of: Result): boolean {
    return this.#failed === of;
  }

  /** Fetches missing results for the current plan. Outdated results are dropped. */
  async follow(copies: number): Promise<void> {
    const { result: of } = this.#slicer;
    if (of === null) return;
    try {
      await this.#fetchPrice(of, copies);
      if (this.#slicer.result !== of) return;
      if (this.#asked?.of !== of) this.#asked = { of, done: this.#fetchCheck(of) };
      await this.#asked.done;
      this.#failed = null;
    } catch (error) {
      // The worker was stopped, as by a new choice: the next event retries.
      if (this.#asked?.of === of) this.#asked = null;
      if (isAbort(error)) return;
      console.error(error);
      this.#failed = of;
      this.#changed();
    }
  }

  async #fetchCheck(of: Result): Promise<void> {
    const check = await this.#slicer.slicer.check(LIMITS);
    if (this.#slicer.result !== of) return;
    this.#checked = { of, check };
    this.#changed();
  }

  async #fetchPrice(of: Result, copies: number): Promise<void> {
    const printer = PRINTERS.find(({ name }) => name === of.report.printer);
    const resin = RESINS.find(({ name }) => name === of.report.resin.name);
    if (printer === undefined || resin === undefined || this.price(of, copies) !== null) return;
    const price = await this.#slicer.slicer.price(pricesOf(printer, resin), { copies });
    if (this.#slicer.result !== of) return;
    this.#priced = { of, copies, price };
    this.#changed();
  }
}
