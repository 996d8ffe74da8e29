/** Admits a limited number of orders at once, and works on one of them at a time. */
import { Refusal } from "./refusal.js";

export class Queue {
  readonly #places: number;
  #taken = 0;
  #last: Promise<unknown> = Promise.resolve();

  /** @param places how many orders may be under way, from the first byte of their upload on */
  constructor(places: number) {
    this.#places = places;
  }

  /** Holds a place while `visit` runs; refuses if none is free. */
  async admit<T>(visit: () => Promise<T>): Promise<T> {
    if (this.#taken >= this.#places) {
      throw new Refusal("busy", "Many orders are being checked just now. Please try again in a minute.");
    }
    this.#taken++;
    try {
      return await visit();
    } finally {
      this.#taken--;
    }
  }

  /** Runs one piece of work at a time, in the order of arrival. */
  inTurn<T>(work: () => Promise<T>): Promise<T> {
    const mine = this.#last.then(work);
    this.#last = mine.catch(() => undefined);
    return mine;
  }
}
