/** What several test files need built, each in a process of its own: the first of a run that needs it builds it. */
import { existsSync } from "node:fs";
import { cp, mkdir, readFile, rename, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { setTimeout as wait } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { buildPage } from "../examples/shop/build.js";
import { main as pack } from "../package/build.js";

/** The package: the folder of its files and of its tarball. */
export async function builtPackage(): Promise<string> {
  await once("package", pack);
  return fileURLToPath(new URL("../dist-package", import.meta.url));
}

/** The shop's page. A copy, since a shop that is started as its owner starts it builds the page anew. */
export async function builtShop(): Promise<string> {
  const copy = join(await scratch(), "shop");
  await once("shop", async () => cp(await buildPage(), copy, { recursive: true }));
  return copy;
}

/** The run's folder. Imported here, since vitest cannot be imported by what it does not run. */
async function scratch(): Promise<string> {
  return (await import("vitest")).inject("scratch");
}

async function once(name: string, build: () => Promise<unknown>): Promise<void> {
  // Measurements run without vitest, and alone.
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
    // Written elsewhere and renamed, so that nobody reads half of it.
    await writeFile(`${outcome}.new`, failure);
    await rename(`${outcome}.new`, outcome);
  }
  // At most until the hook that waits times out.
  while (!existsSync(outcome)) await wait(100);
  const failure = await readFile(outcome, "utf8");
  if (failure !== "") throw new Error(`the ${name} could not be built: ${failure}`);
}
