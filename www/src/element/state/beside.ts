/** Fetches what is shown beside a plan: the mask of the selected layer, then the trade-off curve. */
import { isAbort } from "../../api/error.js";
import type { Mask, Slicer } from "../../api/index.js";
import type { Curve } from "./curve.js";
import type { Result } from "./result.js";

/** The plan shown and the selected layer. */
export interface Looked {
  readonly result: Result | null;
  readonly layer: number;
}

export interface BesideHost {
  /** Whether no task is running. */
  isFree(): boolean;
  changed(): void;
  /** The curve has arrived. */
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
