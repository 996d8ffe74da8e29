/** Orders as a customer's browser sends them, made by the native program. */
import { spawnSync } from "node:child_process";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { LIMITS, pricesOf, type PartName } from "../examples/shop/catalogue.js";
import { FILES } from "../examples/shop/server/upload.js";
import { verifiedOf, type Answer, type Verified } from "../examples/shop/server/verify.js";
import { printer, resin } from "./shop-open.js";

/** The files of an order. */
export type Files = Readonly<Record<PartName, Buffer>>;

/** An order, with the native program's verification. */
export interface Good {
  files: Files;
  copies: number;
  verified: Verified;
}

/** @param folder for its files; must not exist */
export async function goodOf(cusp: string, folder: string, model: Uint8Array, copies: number): Promise<Good> {
  await mkdir(folder);
  const { note: _note, swatch: _swatch, ml_cents: _cents, ...cured } = resin;
  const given = { "resin.json": cured, "limits.json": LIMITS, "prices.json": pricesOf(printer, resin) };
  for (const [name, value] of Object.entries(given)) await writeFile(join(folder, name), JSON.stringify(value));
  await writeFile(join(folder, FILES.model), model);
  // The exit code is 1 if the model is not printable.
  const call = (...words: string[]): Buffer => spawnSync(cusp, [...words, "--json"], { cwd: folder }).stdout;
  const making = ["slice", FILES.model, "-o", FILES.print, "--printer", printer.name, "--resin", "resin.json", "--tolerance", "0.06"];
  // The page sends the report of the plate.
  const { plates } = JSON.parse(call(...making).toString()) as { plates: unknown[] };
  const plan = Buffer.from(JSON.stringify(plates[0]));
  await writeFile(join(folder, FILES.plan), plan);
  const terms = ["--limits", "limits.json", "--prices", "prices.json", "--copies", String(copies)];
  const answer = call("verify", FILES.plan, FILES.model, "--print", FILES.print, ...terms);
  const print = await readFile(join(folder, FILES.print));
  return { files: { plan, model: Buffer.from(model), print }, copies, verified: verifiedOf(JSON.parse(answer.toString()) as Answer) };
}
