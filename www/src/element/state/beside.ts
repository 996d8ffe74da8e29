/** What is shown beside a plan: the mask of the layer looked at, and when that is there the trade-off curve. */
import { isAbort } from "../../api/error.js";
import type { Mask, Slicer } from "../../api/index.js";
import type { Curve } from "./curve.js";
import type { Result } from "./result.js";

/** The plan on show, and the layer looked at. */
export interface Looked {
  readonly result: Result | null;
  readonly layer: number;
}

export interface BesideHost {
  /** Whether nothing else is under way. */
  isFree(): boolean;
  changed(): void;
  /** The curve has come. */
  curved(): void;
  failed(error: unknown): void;
}

export class Beside {
  mask: Mask | null = null;
  readonly #looked: Looked;
  readonly #host: BesideHost;
  readonly #slicer: Pick<Slicer, "mask" | "tradeoff">;
  readonly #curve: Curve;
  #isFetching = false;
  #maskOf: Result | null = null;

  constructor(looked: Looked, host: BesideHost, slicer: Pick<Slicer, "mask" | "tradeoff">, curve: Curve) {
    this.#looked = looked;
    this.#host = host;
    this.#slicer = slicer;
    this.#curve = curve;
  }

  /**
   * Fetches what is missing. One call at a time, and none while a task runs: the worker would not answer, and when it ends
   * this is called again.
   */
  async fetch(): Promise<void> {
    if (this.#isFetching) return;
    this.#isFetching = true;
    const host = this.#host;
    try {
      while (host.isFree()) {
        const { result } = this.#looked;
        if (result === null) break;
        const fetched = (await this.#fetchMask(result)) || (await this.#fetchCurve(result));
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

  /** Whether there was a mask to fetch. The newest layer wins. */
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

  /** Whether there was a curve to fetch. */
  async #fetchCurve(result: Result): Promise<boolean> {
    if (!(await this.#curve.fetch(this.#slicer, result))) return false;
    this.#host.changed();
    this.#host.curved();
    return true;
  }
}
