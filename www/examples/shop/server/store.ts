/** Orders as folders of files. An order exists as a whole or not at all. */
import { createHash } from "node:crypto";
import { mkdir, mkdtemp, open, readdir, readFile, rename, rm, writeFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import type { Price } from "cusp-slicer";
import type { Verified } from "./verify.js";

/** To be printed, or to be reviewed by a person first. */
export type State = "accepted" | "review";

/** Folder of the orders in each state. */
export const FOLDERS: Readonly<Record<State, string>> = { review: "review", accepted: "orders" };

/** Content of an order's `order.json`, stored with its files, and its state, given by the folder. */
export interface Order {
  id: string;
  state: State;
  /** ISO 8601. */
  placed_at: string;
  /** The customer's name of the model file, safe to show; empty if there was none. */
  model_name: string;
  printer: string;
  resin: string;
  copies: number;
  /** Lines of the price. */
  lines: Price["lines"];
  price_cents: number;
  /** Result of `cusp verify`, with the verdict and its reasons. */
  verified: Verified;
}

export class Store {
  readonly #root: string;
  readonly #incoming: string;

  private constructor(folder: string) {
    this.#root = folder;
    // On the same file system, so that an order is moved, not copied.
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

  /** Runs `work` with an empty folder, which is removed afterwards unless it was kept. */
  async withFolder<T>(work: (folder: string) => Promise<T>): Promise<T> {
    const folder = await mkdtemp(join(this.#incoming, "order-"));
    try {
      return await work(folder);
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  }

  /** The order taken for a key; null if there is none. */
  async find(key: string): Promise<Order | null> {
    // In this order, so that an order accepted between the two looks is found by the second.
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
    // Files reach the disk before the order does, and the order before the reply to the customer: a power failure loses none.
    for (const name of await readdir(folder)) await sync(join(folder, name), "r+");
    await sync(folder);
    // Fails if there already is an order, since its folder is not empty.
    const kept = join(this.#root, FOLDERS[state]);
    await rename(folder, join(kept, placed.id));
    await sync(kept);
    return { ...placed, state };
  }
}

/** Flushes the content of a file, or the entries of a folder, to disk. */
async function sync(path: string, flags = "r"): Promise<void> {
  // Windows flushes entries by itself, and opens no folders.
  if (flags === "r" && process.platform === "win32") return;
  const file = await open(path, flags);
  try {
    await file.sync();
  } finally {
    await file.close();
  }
}

/** Public number of an order, by which the folders show used keys. Keys are secret; the hash does not reveal them. */
function idOf(key: string): string {
  return createHash("sha256").update(key).digest("hex").slice(0, 32);
}
