/** The example shop, started for a test: its server in this process, and the files in its folder. */
import { mkdtemp, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterAll, afterEach, beforeAll, expect } from "vitest";
import { PRINTERS, RESINS, type ShopPrinter, type ShopResin } from "../examples/shop/catalogue.js";
import { createShop, type Limits, type Shop } from "../examples/shop/server/shop.js";
import { FOLDERS, type Order, type State } from "../examples/shop/server/store.js";
import { builtShop } from "./built.js";

/** The resin and the printer of test orders. */
export const [resin, printer] = [RESINS[1], PRINTERS[0]].map((it) => {
  if (it === undefined) throw new Error("the shop has nothing to sell");
  return it;
}) as [ShopResin, ShopPrinter];

export interface OpenShop {
  address: string;
  folder: string;
  /** Closes the shop before the test ends. */
  close(): Promise<void>;
}

export interface Shops {
  /** Creates a folder for the test. */
  folder(name: string): Promise<string>;
  /** Opens a shop, which closes when the test ends; in a new folder unless one is given. */
  open(cusp: string, limits?: Partial<Limits>, folder?: string): Promise<OpenShop>;
  /** A stand-in for the native program. */
  program(script: string): Promise<string>;
}

/** @param page creates the folder of the page to serve, inside a folder that is removed in the end */
export function shops(page: (root: string) => Promise<string> = builtShop): Shops {
  let built: string;
  let root: string;
  const opened: Shop[] = [];

  beforeAll(async () => {
    root = await mkdtemp(join(tmpdir(), "cusp-shop-test-"));
    built = await page(root);
  }, 120_000);

  afterEach(async () => {
    await Promise.all(opened.splice(0).map((shop) => shop.close()));
  });

  afterAll(() => rm(root, { recursive: true, force: true }));

  const folder = (name: string): Promise<string> => mkdtemp(join(root, `${name}-`));
  return {
    folder,
    async open(cusp, limits = {}, at) {
      const orders = at ?? (await folder("orders"));
      const shop = await createShop({ folder: orders, pages: built, cusp, ...limits });
      opened.push(shop);
      const address = await shop.listen(0);
      return { address, folder: orders, close: () => shop.close() };
    },
    async program(script) {
      const path = join(await folder("program"), "cusp");
      await writeFile(path, `#!${process.execPath}\n${script}\n`, { mode: 0o755 });
      return path;
    },
  };
}

/** Answer of the shop: an order, or the reason for a refusal. */
export interface Answer extends Partial<Order> {
  status: number;
  code?: string;
  message?: string;
}

export interface Sent {
  key: string;
  parts: Readonly<Record<string, string | Blob>>;
  headers?: Readonly<Record<string, string>>;
  signal?: AbortSignal;
}

/** Posts an order without a browser. */
export async function send(address: string, { key, parts, headers = {}, signal }: Sent): Promise<Answer> {
  const form = new FormData();
  for (const [name, part] of Object.entries(parts)) form.set(name, part);
  const init = { method: "POST", body: form, headers: { "idempotency-key": key, ...headers }, signal: signal ?? null };
  const response = await fetch(`${address}orders`, init);
  return { status: response.status, ...((await response.json()) as object) };
}

/** Numbers of the orders taken, and of those to be reviewed. */
export async function orders(open: Pick<OpenShop, "folder">): Promise<string[]> {
  return [...(await ordersIn(open, "accepted")), ...(await ordersIn(open, "review"))];
}

export function ordersIn({ folder }: Pick<OpenShop, "folder">, state: State): Promise<string[]> {
  return readdir(join(folder, FOLDERS[state]));
}

/** Uploads not yet taken or refused. */
export function incoming({ folder }: Pick<OpenShop, "folder">): Promise<string[]> {
  return readdir(join(folder, "incoming"));
}

/** Expects that refused and aborted uploads leave no files. */
export async function expectNoLeftovers(open: Pick<OpenShop, "folder">): Promise<void> {
  await expect.poll(() => incoming(open)).toEqual([]);
}
