/** Serves a folder on a free port, like a plain web server, under a policy. */
import { createReadStream } from "node:fs";
import { stat } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import type { Served } from "./serve.js";

/** The minimum policy for the element: see docs/embed.md. */
export const ELEMENT_POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'";

/** Policy for the package on another origin, whose worker starts from a `blob:`. */
export const policyFor = (origin: string): string =>
  `default-src 'none'; script-src 'self' ${origin} 'wasm-unsafe-eval'; worker-src blob:; connect-src 'self' ${origin}`;

/** Headers that allow other origins to use the files. */
export const ALLOW_ALL = { "access-control-allow-origin": "*" } as const;

const TYPES: Readonly<Record<string, string>> = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".json": "application/json",
  ".wasm": "application/wasm",
};

export async function serveFolder(folder: string, policy = ELEMENT_POLICY, headers: Readonly<Record<string, string>> = {}): Promise<Served> {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url ?? "/", "http://localhost");
    // Requested by the browser itself; a page's own icon does not matter here.
    if (pathname === "/favicon.ico") return void response.writeHead(204).end();
    const path = join(folder, normalize(decodeURIComponent(pathname.endsWith("/") ? `${pathname}index.html` : pathname)));
    stat(path).then(
      () => {
        const type = TYPES[extname(path)] ?? "application/octet-stream";
        response.writeHead(200, { "content-type": type, "content-security-policy": policy, ...headers });
        createReadStream(path).pipe(response);
      },
      () => response.writeHead(404).end(),
    );
  });
  await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
  const address = server.address();
  if (address === null || typeof address !== "object") throw new Error("no port was free");
  return {
    address: `http://127.0.0.1:${address.port}/`,
    close: () => new Promise((resolve) => void server.close(() => resolve())),
  };
}
