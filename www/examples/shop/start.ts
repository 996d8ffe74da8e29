/** Starts the shop: `npm run shop [-- FOLDER]`. Orders are kept in FOLDER, or in a new temporary folder. */
import { mkdtemp } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { buildCore, buildPage } from "./build.js";
import { createShop, type Setup } from "./server/shop.js";

const PORT = 8090;

export async function main([folder]: string[]): Promise<void> {
  const cusp = buildCore();
  const pages = await buildPage();
  const orders = folder === undefined ? await mkdtemp(join(tmpdir(), "cusp-shop-")) : resolve(folder);
  const address = await run({ folder: orders, pages, cusp }, Number(process.env["PORT"] ?? PORT));
  console.log(`shop    ${address}\norders  ${orders}\ncusp    ${cusp}`);
}

/** Runs the shop until the process is asked to end. Returns the URL. */
export async function run(setup: Setup, port: number): Promise<string> {
  const shop = await createShop(setup);
  const address = await shop.listen(port);
  for (const signal of ["SIGINT", "SIGTERM"] as const) process.once(signal, () => void shop.close());
  return address;
}
