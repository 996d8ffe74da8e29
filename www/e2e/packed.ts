/** A third-party page with the package, served by a plain web server under the element's policy. */
import { cp, mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { builtPackage } from "./built.js";
import type { Served } from "./serve.js";
import { serveFolder } from "./static.js";

/** @param files contents by name; the package is in `cusp-slicer/` */
export async function servePacked(files: Readonly<Record<string, string | Uint8Array>>): Promise<Served> {
  const packed = await builtPackage();
  const folder = await mkdtemp(join(tmpdir(), "cusp-packed-"));
  await cp(packed, join(folder, "cusp-slicer"), { recursive: true });
  for (const [name, content] of Object.entries(files)) await writeFile(join(folder, name), content);
  const served = await serveFolder(folder);
  return {
    address: served.address,
    async close() {
      await served.close();
      await rm(folder, { recursive: true, force: true });
    },
  };
}

/** A page with the headless slicer as `window.api`, and files by name. */
export function serveApi(files: Readonly<Record<string, string | Uint8Array>>): Promise<Served> {
  return servePacked({
    "index.html": `<!doctype html><meta charset="utf-8" /><script type="module" src="main.js"></script>`,
    "main.js": `window.api = await import("./cusp-slicer/index.js");`,
    ...files,
  });
}
