/**
 * Fetches what is shown beside a plan: the mask of the selected layer, the price, what will fail if somebody wants to know, then the
 * trade-off curve.
 */
import { asSlicerError, isAbort, type SlicerError } from "../../api/error.js";
import type { Mask, Ordered, Slicer } from "../../api/index.js";
import type { Price, Prices } from "../../api/wire.js";
import type { Checks } from "./checks.js";
import type { Curve } from "./curve.js";
import { isEqual } from "./plain.js";
import type { Result } from "./result.js";

/** The plan shown and the selected layer. */
export interface Looked {
  readonly result: Result | null;
  readonly layer: number;
}

/** What a shop asks, and the finish that is ordered. */
export interface Asked extends Omit<Ordered, "copies"> {
  readonly prices: Prices;
}

export interface BesideHost {
  /** Returns true if no task is running. */
  isFree(): boolean;
  changed(): void;
  /** The curve has arrived. */
  curved(): void;
  failed(error: unknown): void;
  priced(price: Price): void;
  /** The page's prices cannot be used. */
  mispriced(error: SlicerError): void;
}

export class Beside {
  mask: Mask | null = null;
  /** What the last result costs, by {@link asked}. */
  price: Price | null = null;
  readonly #looked: Looked;
  readonly #host: BesideHost;
  readonly #slicer: Pick<Slicer, "mask" | "tradeoff" | "price">;
  readonly #curve: Curve;
  readonly #checks: Checks;
  #isFetching = false;
  #maskOf: Result | null = null;
  #asked: Asked | null = null;
  #priceOf: Result | null = null;

  constructor(looked: Looked, host: BesideHost, slicer: Pick<Slicer, "mask" | "tradeoff" | "price">, { curve, checks }: { curve: Curve; checks: Checks }) {
    this.#looked = looked;
    this.#host = host;
    this.#slicer = slicer;
    this.#curve = curve;
    this.#checks = checks;
  }

  /**
   * Fetches what is missing, one call at a time. Does nothing while a task runs: the worker would not answer, and this is
   * called again when the task ends.
   */
  async fetch(): Promise<void> {
    if (this.#isFetching) return;
    this.#isFetching = true;
    const host = this.#host;
    try {
      while (host.isFree()) {
        const { result } = this.#looked;
        if (result === null) break;
        const fetched =
          (await this.#fetchMask(result)) ||
          (await this.#fetchPrice(result)) ||
          (await this.#checks.fetch(result)) ||
          (await this.#fetchCurve(result));
        if (!fetched) break;
      }
    } catch (error) {
      if (!host.isFree() || isAbort(error)) return;
      host.failed(error);
      host.changed();
    } finally {
      this.#isFetching = false;
    }
  }

  /** Returns true if the price is that of the result. */
  get isPriced(): boolean {
    return this.#priceOf === this.#looked.result;
  }

  get asked(): Asked | null {
    return this.#asked;
  }

  set asked(asked: Asked | null) {
    if (isEqual(asked, this.#asked)) return;
    this.#asked = asked;
    this.#priceOf = null;
    if (asked === null) this.price = null;
    this.#host.changed();
    void this.fetch();
  }

  /** Fetches what the result costs; false if nobody asks, or it is known. */
  async #fetchPrice(result: Result): Promise<boolean> {
    const asked = this.#asked;
    if (asked === null || this.#priceOf === result) return false;
    const { prices, ...ordered } = asked;
    const priced = await this.#slicer.price(prices, ordered).catch((error: unknown) => {
      if (isAbort(error)) throw error;
      return asSlicerError(error);
    });
    if (this.#looked.result !== result || this.#asked !== asked) return true;
    this.#priceOf = result;
    this.price = priced instanceof Error ? null : priced;
    if (priced instanceof Error) this.#host.mispriced(priced);
    else this.#host.priced(priced);
    this.#host.changed();
    return true;
  }

  /** Fetches the mask of the newest selected layer; false if there was none to fetch. */
  async #fetchMask(result: Result): Promise<boolean> {
    const { layer } = this.#looked;
    if (this.mask?.layer === layer && this.#maskOf === result) return false;
    const mask = await this.#slicer.mask(layer);
    if (this.#looked.result === result) {
      this.mask = mask;
      this.#maskOf = result;
      this.#host.changed();
    }
    return true;
  }

  /** Fetches the trade-off curve; false if there was none to fetch. */
  async #fetchCurve(result: Result): Promise<boolean> {
    if (!(await this.#curve.fetch(this.#slicer, result))) return false;
    this.#host.changed();
    this.#host.curved();
    return true;
  }
}
