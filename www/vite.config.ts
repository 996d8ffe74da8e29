import { defineConfig, type Plugin } from "vite";

/**
 * The policy that makes "your model never leaves this computer" a promise the browser keeps: scripts, workers and
 * requests only from where the page itself came from. Built pages only, since the development server injects scripts.
 * Inline styles are let through because lit and uPlot set them on elements.
 */
const POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "worker-src 'self'",
  "connect-src 'self'",
  "style-src 'self' 'unsafe-inline'",
  "img-src 'self' data: blob:",
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

export default defineConfig({
  // Relative addresses, so that the folder works under any path of any host.
  base: "./",
  plugins: [contentSecurityPolicy()],
  worker: { format: "es" },
  build: { target: "es2022", assetsInlineLimit: 0, reportCompressedSize: true },
});
