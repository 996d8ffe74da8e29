import { defineConfig, type Plugin } from "vite";
import { fileURLToPath } from "node:url";
import { anyLanguage } from "./package/any-language.js";
import { crateParts, noticesOf, npmParts } from "./package/bill.js";

/**
 * The policy that makes "your model never leaves this computer" a promise the browser keeps: scripts, workers and
 * requests only from where the page itself came from. Built pages only, since the development server injects scripts.
 */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "connect-src 'self'",
  "style-src 'self'",
  "img-src 'self'",
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

/** Styles without comments, and without white space that separates nothing. */
const lean = (styles: string): string =>
  styles
    .replace(/\/\*[^*]*\*\//g, "")
    .replace(/\s+/g, " ")
    // Not after a value that is filled in: there it may separate two.
    .replace(/([{;:,]|(?<!\$\{[^}]*)}) /g, "$1")
    .replace(/ ([{}])/g, "$1")
    .replace(/;}/g, "}");

/** Leaves out of templates what only readers of the source need: comments in styles, and indentation. */
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

const SERVICE_WORKER = "service-worker";

/** Tells the service worker which files the page is made of. */
function offlineFiles(): Plugin {
  return {
    name: "cusp:offline-files",
    apply: "build",
    // After the page itself is among them.
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

/** Puts the licences of what is bundled beside the page. Added last: nobody needs them without a network. */
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
  // Relative addresses, so that the folder works under any path of any host.
  base: "./",
  plugins: [contentSecurityPolicy(), leanTemplates(), offlineFiles(), notices(), anyLanguage],
  // What the development server bundles beforehand passes by the plugin.
  optimizeDeps: { exclude: ["uplot"] },
  worker: { format: "es" },
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    modulePreload: {
      // Browsers that do not know what is preloaded fetch it a little later; a script for them would be fetched by all.
      polyfill: false,
      // What a part of the page imports is there by then, but for what the view does, and that is fetched ahead.
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
