/** Builds shared by several test files, each a separate process: the first that needs a build makes it. */
import { existsSync } from "node:fs";
import { cp, mkdir, readFile, rename, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { setTimeout as wait } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { buildPage } from "../examples/shop/build.js";
import { main as pack } from "../package/build.js";

/** Builds the package; returns the folder of its files and its tarball. */
export async function builtPackage(): Promise<string> {
  await once("package", pack);
  return fileURLToPath(new URL("../dist-package", import.meta.url));
}

/** Builds the shop's page and copies it, since starting the shop as its owner does rebuilds the page. */
export async function builtShop(): Promise<string> {
  const copy = join(await scratch(), "shop");
  await once("shop", async () => cp(await buildPage(), copy, { recursive: true }));
  return copy;
}

/** The run's folder. Imported dynamically, since vitest cannot be imported outside its runs. */
async function scratch(): Promise<string> {
  return (await import("vitest")).inject("scratch");
}

async function once(name: string, build: () => Promise<unknown>): Promise<void> {
  // Measurements run alone, without vitest.
  if (process.env.VITEST === undefined) return void (await build());
  const outcome = join(await scratch(), `${name}.outcome`);
  const isFirst = await mkdir(`${outcome}.pending`).then(
    () => true,
    () => false,
  );
  if (isFirst) {
    const failure = await build().then(
      () => "",
      (error: unknown) => String(error),
    );
    // Written elsewhere and renamed, so that no process reads half of it.
    await writeFile(`${outcome}.new`, failure);
    await rename(`${outcome}.new`, outcome);
  }
  // At most until the waiting hook times out.
  while (!existsSync(outcome)) await wait(100);
  const failure = await readFile(outcome, "utf8");
  if (failure !== "") throw new Error(`the ${name} could not be built: ${failure}`);
}
