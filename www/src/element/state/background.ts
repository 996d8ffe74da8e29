/**
 * Background queries after a plan: the mask of the selected layer, the price, the findings if requested, the trade-off curve, and the
 * findings if watched.
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

/** Prices of a shop, and the finish ordered. */
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
  /** Called if the page's prices are invalid. */
  mispriced(error: SlicerError): void;
}

/** Time after which nobody seems to be changing settings: the next plan would wait for a check under way, which takes about a second. */
const QUIET_MS = 800;

export class BackgroundQueries {
  mask: Mask | null = null;
  /** Mask of the layer below, while its differences are looked at. */
  below: Mask | null = null;
  /** Price of the last result by {@link asked}. */
  price: Price | null = null;
  readonly #looked: Looked;
  readonly #host: BesideHost;
  readonly #slicer: Pick<Slicer, "mask" | "tradeoff" | "price">;
  readonly #curve: Curve;
  readonly #checks: Checks;
  #isFetching = false;
  #maskOf: Result | null = null;
  #seesChanges = false;
  #asked: Asked | null = null;
  #priceOf: Result | null = null;
  /** The last result that was shown for a while, and the one that waits for it. */
  #quiet: Result | null = null;
  #waiting: Result | null = null;

  constructor(looked: Looked, host: BesideHost, slicer: Pick<Slicer, "mask" | "tradeoff" | "price">, { curve, checks }: { curve: Curve; checks: Checks }) {
    this.#looked = looked;
    this.#host = host;
    this.#slicer = slicer;
    this.#curve = curve;
    this.#checks = checks;
  }

  /**
   * Fetches missing results, one call at a time. Does nothing while a task runs: the worker would not answer. It is called again at the end
   * of the task.
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
          (await this.#fetchCurve(result)) ||
          (this.#checks.isWatching && this.#isQuiet(result) && (await this.#checks.fetch(result, true)));
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

  /** Returns true once a result has been shown for a while; calls {@link fetch} then. */
  #isQuiet(result: Result): boolean {
    if (this.#quiet === result) return true;
    if (this.#waiting !== result) {
      this.#waiting = result;
      setTimeout(() => {
        this.#quiet = result;
        void this.fetch();
      }, QUIET_MS);
    }
    return false;
  }

  /** Fetches the price of the result; returns false if not needed. */
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

  /** Fetches the mask of the selected layer; returns false if not needed. */
  async #fetchMask(result: Result): Promise<boolean> {
    const { layer } = this.#looked;
    const [isThere, isBelow] = [this.mask, this.below].map((mask, down) => mask?.layer === layer - down && this.#maskOf === result);
    if (isThere === true && (isBelow === true || layer === 0 || !this.#seesChanges)) return false;
    const mask = await this.#slicer.mask(isThere === true ? layer - 1 : layer);
    if (this.#looked.result !== result) return true;
    if (isThere === true) this.below = mask;
    else {
      // One layer up, the mask is the one below.
      this.below = this.#maskOf === result ? this.mask : null;
      this.mask = mask;
      this.#maskOf = result;
    }
    this.#host.changed();
    return true;
  }

  /** True while changes from the layer below are looked at. */
  set seesChanges(on: boolean) {
    this.#seesChanges = on;
    void this.fetch();
  }

  /** Fetches the trade-off curve; returns false if not needed. */
  async #fetchCurve(result: Result): Promise<boolean> {
    if (!(await this.#curve.fetch(this.#slicer, result))) return false;
    this.#host.changed();
    this.#host.curved();
    return true;
  }
}
