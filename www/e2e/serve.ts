/** Serves the built page on a free port, for the tests and related tools. */
import { existsSync } from "node:fs";
import { mkdtemp, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { preview } from "vite";
import type { TestProject } from "vitest/node";

const root = fileURLToPath(new URL("..", import.meta.url));

declare module "vitest" {
  interface ProvidedContext {
    address: string;
    /** A folder of this run of the tests. */
    scratch: string;
  }
}

export interface Served {
  address: string;
  close(): Promise<void>;
}

/** @param folder of the built page; by default that of this checkout */
export async function serve(folder = join(root, "dist")): Promise<Served> {
  if (!existsSync(join(folder, "index.html"))) {
    throw new Error(`there is no page in ${folder}: run \`npm run build\` first`);
  }
  const port = await freePort();
  const server = await preview({
    root,
    logLevel: "error",
    build: { outDir: folder },
    preview: { host: "127.0.0.1", port, strictPort: true, open: false },
  });
  return { address: `http://127.0.0.1:${port}/`, close: () => server.close() };
}

/** Vitest's global set-up. */
export default async function setup(project: TestProject): Promise<() => Promise<void>> {
  const served = await serve();
  const scratch = await mkdtemp(join(tmpdir(), "cusp-e2e-"));
  // Browsers end with their worker, but leave their profiles behind.
  process.env["TMPDIR"] = scratch;
  project.provide("address", served.address);
  project.provide("scratch", scratch);
  return async () => {
    await served.close();
    await rm(scratch, { recursive: true, maxRetries: 20 });
  };
}

export function freePort(): Promise<number> {
  return new Promise((resolve, reject) => {
    const probe = createServer();
    probe.on("error", reject);
    probe.listen(0, "127.0.0.1", () => {
      const address = probe.address();
      probe.close(() => {
        if (address !== null && typeof address === "object") resolve(address.port);
        else reject(new Error("no port was free"));
      });
    });
  });
}
