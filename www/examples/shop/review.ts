/** Lists the orders that wait for a person, after accepting some of them: `npm run shop:review -- FOLDER [ID…]`. */
import { readdir, readFile, rename } from "node:fs/promises";
import { join } from "node:path";
import { money } from "./page/format.js";
import { FOLDERS, type Order } from "./server/store.js";

export async function main([folder = ".", ...accepted]: string[]): Promise<void> {
  const waiting = join(folder, FOLDERS.review);
  for (const id of accepted) await rename(join(waiting, id), join(folder, FOLDERS.accepted, id));
  for (const id of await readdir(waiting)) {
    const order = JSON.parse(await readFile(join(waiting, id, "order.json"), "utf8")) as Order;
    const { placed_at, copies, model_name, printer, resin, price_cents, verified } = order;
    const found = verified.printability.models.flatMap((model) => model.counts).map(({ code }) => code).join(", ");
    console.log([id, placed_at, `${copies} × ${model_name}`, `${printer}, ${resin}`, money(price_cents), found].join("  "));
  }
}
