/** Places for orders in progress: a total, and fewer per client. */
import { Refusal } from "./refusal.js";

export class Places {
  readonly #all: number;
  readonly #perClient: number;
  /** Clients that hold a place, once per place. */
  readonly #holders: string[] = [];

  constructor(all: number, perClient: number) {
    this.#all = all;
    this.#perClient = perClient;
  }

  /** Takes a place and returns a function that frees it; refuses if none is free. */
  take(client: string): () => void {
    if (this.#holders.filter((holder) => holder === client).length >= this.#perClient) {
      throw new Refusal("too-many-orders", "Several of your orders are under way. Please try again when one of them is done.");
    }
    if (this.#holders.length >= this.#all) {
      throw new Refusal("busy", "Many orders are being checked just now. Please try again in a minute.");
    }
    this.#holders.push(client);
    return () => void this.#holders.splice(this.#holders.indexOf(client), 1);
  }
}
