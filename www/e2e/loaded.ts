/** What a page loads before its 3-D view, beside the wasm. */
import { gzipSync } from "node:zlib";
import type { Page } from "playwright-core";

/** From now on, the gzipped size of each script, style and document that the page fetches, by its path; those of the view are left out. */
export async function beforeView(page: Page): Promise<Map<string, number>> {
  const sizes = new Map<string, number>();
  page.on("response", (response) => {
    const { pathname } = new URL(response.url());
    if (!/\.(js|css|html)$|\/$/.test(pathname)) return;
    void response.body().then(
      // The view's own chunks, and that of three.
      (body) => (/cusp-view/.test(pathname) || body.includes("WebGLRenderer") ? null : sizes.set(pathname, gzipSync(body).length)),
      () => undefined,
    );
  });
  // With a route there is no cache, whose answers have no bodies.
  await page.route("**/*", (route) => route.continue());
  return sizes;
}

/** The sum of the sizes. */
export const whole = (sizes: ReadonlyMap<string, number>): number => [...sizes.values()].reduce((sum, size) => sum + size, 0);
