/** Orders as folders of files. An order exists as a whole or not at all. */
import { createHash } from "node:crypto";
import { mkdir, mkdtemp, open, readdir, readFile, rename, rm, writeFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import type { Price } from "cusp-slicer";
import type { Verified } from "./verify.js";

/** To be printed, or to be looked at by a person first. */
export type State = "accepted" | "review";

/** The folder of the orders in a state. */
export const FOLDERS: Readonly<Record<State, string>> = { review: "review", accepted: "orders" };

/** The content of an order's `order.json`, which lies beside its files, and its state, which is where they lie. */
export interface Order {
  id: string;
  state: State;
  /** ISO 8601. */
  placed_at: string;
  /** The customer's name of the model's file, fit to be shown; empty if there was none. */
  model_name: string;
  printer: string;
  resin: string;
  copies: number;
  /** The lines that make up the price. */
  lines: Price["lines"];
  price_cents: number;
  /** What `cusp verify` found, with the verdict and its reasons. */
  verified: Verified;
}

export class Store {
  readonly #root: string;
  readonly #incoming: string;

  private constructor(folder: string) {
    this.#root = folder;
    // On one file system, so that an order is moved and not copied.
    this.#incoming = join(folder, "incoming");
  }

  /** Removes the remains of interrupted uploads. */
  static async open(folder: string): Promise<Store> {
    const store = new Store(resolve(folder));
    await rm(store.#incoming, { recursive: true, force: true });
    await mkdir(store.#incoming, { recursive: true });
    for (const name of Object.values(FOLDERS)) await mkdir(join(store.#root, name), { recursive: true });
    return store;
  }

  /** Gives `work` an empty folder, which is removed afterwards unless it was kept. */
  async withFolder<T>(work: (folder: string) => Promise<T>): Promise<T> {
    const folder = await mkdtemp(join(this.#incoming, "order-"));
    try {
      return await work(folder);
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  }

  /** The order that was taken for a key; null if none was. */
  async find(key: string): Promise<Order | null> {
    // In this order: one that is accepted between two looks is seen by the second.
    for (const state of ["review", "accepted"] as const) {
      try {
        const kept = await readFile(join(this.#root, FOLDERS[state], idOf(key), "order.json"), "utf8");
        return { ...(JSON.parse(kept) as Omit<Order, "state">), state };
      } catch (error) {
        if ((error as NodeJS.ErrnoException).code !== "ENOENT") throw error;
      }
    }
    return null;
  }

  /** Turns a folder with its files into an order. A key has at most one order: there must be none yet. */
  async keep(folder: string, key: string, { state, ...order }: Omit<Order, "id" | "placed_at">): Promise<Order> {
    const placed = { id: idOf(key), placed_at: new Date().toISOString(), ...order };
    await writeFile(join(folder, "order.json"), `${JSON.stringify(placed, null, 2)}\n`);
    // On the disk before it is an order, and an order before the customer is told: no power failure takes it back.
    for (const name of await readdir(folder)) await sync(join(folder, name), "r+");
    await sync(folder);
    // This fails if there already is an order, since its folder is not empty.
    const kept = join(this.#root, FOLDERS[state]);
    await rename(folder, join(kept, placed.id));
    await sync(kept);
    return { ...placed, state };
  }
}

/** Waits until the disk has the content of a file, or the names in a folder. */
async function sync(path: string, flags = "r"): Promise<void> {
  // Windows keeps names by itself, and opens no folders.
  if (flags === "r" && process.platform === "win32") return;
  const file = await open(path, flags);
  try {
    await file.sync();
  } finally {
    await file.close();
  }
}

/**
 * The number of a key's order, so that the folders show which keys are used. Numbers are public and keys secret; a hash
 * does not reveal its key.
 */
function idOf(key: string): string {
  return createHash("sha256").update(key).digest("hex").slice(0, 32);
}
