/** Files that a page loads before its 3-D view, besides the wasm. */
import { gzipSync } from "node:zlib";
import type { Page } from "playwright-core";

/** Records the gzipped size of each script, style and document fetched from now on, by path; those of the view are omitted. */
export async function beforeView(page: Page): Promise<Map<string, number>> {
  const sizes = new Map<string, number>();
  page.on("response", (response) => {
    const { pathname } = new URL(response.url());
    if (!/\.(js|css|html)$|\/$/.test(pathname)) return;
    void response.body().then(
      // The view's own chunks, three.js, and what is fetched after them.
      (body) => (/cusp-view|view-tools|viewing|view-texts|-rest/.test(pathname) || body.includes("WebGLRenderer") ? null : sizes.set(pathname, gzipSync(body).length)),
      () => undefined,
    );
  });
  // Routing disables the cache, whose responses have no bodies.
  await page.route("**/*", (route) => route.continue());
  return sizes;
}

/** Sum of the sizes. */
export const whole = (sizes: ReadonlyMap<string, number>): number => [...sizes.values()].reduce((sum, size) => sum + size, 0);
