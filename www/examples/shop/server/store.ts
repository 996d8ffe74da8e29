/** Orders as folders of files. An order is there as a whole or not at all. */
import { randomUUID } from "node:crypto";
import { mkdir, mkdtemp, rename, rm, writeFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import type { Line } from "../price.js";
import type { Verdict } from "./verify.js";

/** What is written of an order, beside its three files, as `order.json`. */
export interface Order {
  id: string;
  /** ISO 8601. */
  placed_at: string;
  printer: string;
  resin: string;
  copies: number;
  /** What the price is made of. */
  lines: readonly Line[];
  price_cents: number;
  verdict: Verdict;
}

export class Store {
  readonly #incoming: string;
  readonly #orders: string;

  private constructor(folder: string) {
    // On one file system, so that an order that was accepted is moved and not copied.
    this.#incoming = join(folder, "incoming");
    this.#orders = join(folder, "orders");
  }

  /** Removes what uploads that never ended have left. */
  static async open(folder: string): Promise<Store> {
    const store = new Store(resolve(folder));
    await rm(store.#incoming, { recursive: true, force: true });
    await mkdir(store.#incoming, { recursive: true });
    await mkdir(store.#orders, { recursive: true });
    return store;
  }

  /** Gives `work` an empty folder, which is gone afterwards unless it was kept. */
  async withFolder<T>(work: (folder: string) => Promise<T>): Promise<T> {
    const folder = await mkdtemp(join(this.#incoming, "order-"));
    try {
      return await work(folder);
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  }

  /** Makes an order of a folder with its files. */
  async keep(folder: string, order: Omit<Order, "id" | "placed_at">): Promise<Order> {
    const placed: Order = { id: randomUUID(), placed_at: new Date().toISOString(), ...order };
    await writeFile(join(folder, "order.json"), `${JSON.stringify(placed, null, 2)}\n`);
    await rename(folder, join(this.#orders, placed.id));
    return placed;
  }
}
