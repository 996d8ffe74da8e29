/** Who may be served: so many orders at once, and of those one that is worked on. */
import { Refusal } from "./refusal.js";

export class Queue {
  readonly #places: number;
  #taken = 0;
  #last: Promise<unknown> = Promise.resolve();

  /** @param places how many orders may be under way, from the first byte of their upload on */
  constructor(places: number) {
    this.#places = places;
  }

  /** Keeps a place while `visit` lasts; refuses if there is none. */
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

  /** Does one piece of work after another, in the order in which they came. */
  inTurn<T>(work: () => Promise<T>): Promise<T> {
    const mine = this.#last.then(work);
    this.#last = mine.catch(() => undefined);
    return mine;
  }
}
