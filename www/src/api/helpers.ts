/** Helper workers: encode layers of print files for the worker that holds the plan. They hold no model, and end when idle for long. */
import type { Client } from "./client.js";
import type { Format } from "./wire.js";

/** Helpers are terminated after this long without work. */
const IDLE_MS = 10_000;

export class Helpers {
  readonly #most: number;
  readonly #start: () => Client;
  readonly #clients: { client: Client; busy: number }[] = [];
  #timer: ReturnType<typeof setTimeout> | undefined;

  /**
   * @param start creates a client, whose worker starts when first needed
   * @param most maximum number of helpers
   */
  constructor(start: () => Client, most: number) {
    this.#most = most;
    this.#start = start;
  }

  /** Encodes a group of layers in the least busy helper; null on failure. */
  async encode(format: Format, canvas: Uint32Array, runs: Uint32Array): Promise<Uint8Array | null> {
    clearTimeout(this.#timer);
    const helper = this.#leastBusy();
    helper.busy += 1;
    try {
      return await helper.client.encodeGroup(format, canvas, runs);
    } catch {
      // The caller then encodes the group itself and reports any error.
      return null;
    } finally {
      helper.busy -= 1;
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.rest(), IDLE_MS);
    }
  }

  /** Terminates the helpers until they are needed again. */
  rest(): void {
    clearTimeout(this.#timer);
    for (const { client } of this.#clients) client.rest();
  }

  /** Terminates the helpers for good. */
  dispose(): void {
    clearTimeout(this.#timer);
    for (const { client } of this.#clients) client.dispose();
  }

  #leastBusy(): { client: Client; busy: number } {
    const free = this.#clients.find(({ busy }) => busy === 0);
    if (free !== undefined) return free;
    if (this.#clients.length < this.#most) {
      const started = { client: this.#start(), busy: 0 };
      this.#clients.push(started);
      return started;
    }
    return this.#clients.reduce((least, other) => (other.busy < least.busy ? other : least));
  }
}
