import { defineConfig, type Plugin } from "vite";
import { fileURLToPath } from "node:url";
import { anyLanguage } from "./package/any-language.js";
import { crateParts, noticesOf, npmParts } from "./package/bill.js";
import { dictionaries } from "./package/dictionaries.js";

/**
 * Policy with which the browser enforces that a model never leaves the computer: scripts, workers and requests only from the page's own
 * origin. Applies to built pages only, since the development server injects scripts.
 */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "connect-src 'self'",
  "style-src 'self'",
  "img-src 'self'",
  "manifest-src 'self'",
  "form-action 'none'",
  "base-uri 'none'",
].join("; ");

function contentSecurityPolicy(): Plugin {
  return {
    name: "cusp:content-security-policy",
    apply: "build",
    transformIndexHtml: () => [
      { tag: "meta", attrs: { "http-equiv": "Content-Security-Policy", content: POLICY }, injectTo: "head-prepend" },
    ],
  };
}

/** Removes comments and redundant white space from styles. */
const lean = (styles: string): string =>
  styles
    .replace(/\/\*[^*]*\*\//g, "")
    .replace(/\s+/g, " ")
    // Not after an interpolated value, where it may be significant.
    .replace(/([{;:,]|(?<!\$\{[^}]*)}) /g, "$1")
    .replace(/ ([{}])/g, "$1")
    .replace(/;}/g, "}");

/** Removes comments in styles, and indentation, from templates. */
function leanTemplates(): Plugin {
  return {
    name: "cusp:lean-templates",
    apply: "build",
    enforce: "pre",
    transform: {
      filter: { id: /\/src\/[^?]*\.ts$/, code: /\b(css|html)`/ },
      handler: (code) => code.replace(/css`[^`]*`/g, lean).replace(/\n\s+/g, "\n"),
    },
  };
}

/** Adds the manifest with which browsers install the page as an app. */
function appManifest(): Plugin {
  return {
    name: "cusp:app-manifest",
    apply: "build",
    transformIndexHtml: () => [{ tag: "link", attrs: { rel: "manifest", href: "./manifest.webmanifest" }, injectTo: "head" }],
    generateBundle(_options, bundle) {
      const icon = Object.values(bundle).find((it) => it.type === "asset" && it.originalFileNames.includes("src/page/icon.svg"));
      if (icon === undefined) this.error("the page has no icon");
      const manifest = {
        name: "Cusp",
        description: "Adaptive layers for resin printing",
        start_url: "./",
        scope: "./",
        display: "standalone",
        background_color: "#f4f5f7",
        theme_color: "#1f4f96",
        icons: [{ src: icon.fileName, sizes: "any", type: "image/svg+xml", purpose: "any" }],
      };
      this.emitFile({ type: "asset", fileName: "manifest.webmanifest", source: JSON.stringify(manifest) });
    },
  };
}

const SERVICE_WORKER = "service-worker";

/** Inserts the list of the page's files into the service worker. */
function offlineFiles(): Plugin {
  return {
    name: "cusp:offline-files",
    apply: "build",
    // Runs after the page itself has been added.
    enforce: "post",
    generateBundle(_options, bundle) {
      const files = Object.keys(bundle).filter((name) => name !== `${SERVICE_WORKER}.js`).sort();
      for (const chunk of Object.values(bundle)) {
        if (chunk.type === "chunk" && chunk.name === SERVICE_WORKER) {
          chunk.code = chunk.code.replaceAll("__FILES__", JSON.stringify(files));
        }
      }
    },
  };
}

/** Adds the licences of bundled code to the page. Added last, since they are not needed offline. */
function notices(): Plugin {
  return {
    name: "cusp:notices",
    apply: "build",
    enforce: "post",
    async generateBundle(_options, bundle) {
      const root = fileURLToPath(new URL(".", import.meta.url));
      const chunks = Object.values(bundle).filter((it) => it.type === "chunk");
      const parts = [...(await npmParts(root, chunks)), ...(await crateParts(root))];
      this.emitFile({ type: "asset", fileName: "NOTICES.txt", source: noticesOf(parts) });
    },
  };
}

export default defineConfig({
  // Relative URLs, so that the folder works under any path of any host.
  base: "./",
  plugins: [contentSecurityPolicy(), leanTemplates(), appManifest(), offlineFiles(), notices(), anyLanguage, dictionaries(new URL(".", import.meta.url))],
  // Prebundling by the development server would bypass the plugin.
  optimizeDeps: { exclude: ["uplot"] },
  worker: { format: "es" },
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: {
      // Browsers without preloading fetch files a little later; all browsers would fetch a polyfill.
      polyfill: false,
      // Imports of later parts have loaded by then, except those of the view, which is prefetched.
      resolveDependencies: (_file, needed, { hostType }) => (hostType === "html" ? needed : []),
    },
    reportCompressedSize: true,
    rollupOptions: {
      input: { index: "index.html", [SERVICE_WORKER]: "src/page/service-worker.ts" },
      output: {
        entryFileNames: ({ name }) => (name === SERVICE_WORKER ? "[name].js" : "assets/[name]-[hash].js"),
      },
    },
  },
});
