import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";
import { anyLanguage } from "../../package/any-language.js";
import { binaryStl, exampleTriangles } from "../../src/page/example.js";

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** A real shop would place its own file next to its page. */
const sampleModel: Plugin = {
  name: "shop:sample-model",
  generateBundle() {
    this.emitFile({ type: "asset", fileName: "goblet.stl", source: binaryStl(exampleTriangles()) });
  },
};

export default defineConfig({
  root: here("."),
  base: "./",
  // Here the package is built from its source. A real shop runs `npm install cusp-slicer` and needs none of this.
  plugins: [sampleModel, anyLanguage],
  resolve: {
    // Always production: this page is only ever built, and libraries have a separate development build.
    conditions: ["production", "module", "browser", "import", "default"],
    alias: [
      { find: /^cusp-slicer$/, replacement: here("../../src/api/index.ts") },
      { find: /^cusp-slicer\/element$/, replacement: here("../../src/element/register.ts") },
      { find: /^cusp-slicer\/element-class$/, replacement: here("../../src/element/index.ts") },
    ],
  },
  worker: { format: "es" },
  build: { target: "es2022", assetsInlineLimit: 0, modulePreload: { polyfill: false }, reportCompressedSize: false, emptyOutDir: true },
});
