/** Builds the view's own page and serves it, for its tests and for inspection. */
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build, preview } from "vite";
import { freePort, type Served } from "./serve.js";

export async function serveView(): Promise<Served> {
  const root = fileURLToPath(new URL("./view-page", import.meta.url));
  const outDir = await mkdtemp(join(tmpdir(), "cusp-view-"));
  await build({
    root,
    configFile: false,
    base: "./",
    logLevel: "error",
    build: {
      outDir,
      emptyOutDir: true,
      target: "es2022",
      assetsInlineLimit: 0,
      chunkSizeWarningLimit: Infinity,
      rolldownOptions: {
        output: {
          codeSplitting: { groups: [{ name: "three", test: /node_modules[\\/]three/ }] },
        },
      },
    },
  });
  const port = await freePort();
  const server = await preview({
    root,
    configFile: false,
    logLevel: "error",
    build: { outDir },
    preview: { host: "127.0.0.1", port, strictPort: true, open: false },
  });
  return {
    address: `http://127.0.0.1:${port}/`,
    close: async () => {
      await server.close();
      await rm(outDir, { recursive: true });
    },
  };
}
