/** Pages with the view alone, for its tests: one build for all. Fails on unexpected errors at the end. */
import { decode } from "fast-png";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect } from "vitest";
import { SOFTWARE_GL, USUAL } from "./browser.js";
import { tabs, type TabOptions } from "./tabs.js";
import type { Harness, Heard } from "./view-page/main.js";
import { serveView } from "./view-serve.js";

declare global {
  interface Window {
    harness: Harness;
  }
}

export function viewPages(): (options?: TabOptions) => Promise<Page> {
  let served: Awaited<ReturnType<typeof serveView>>;
  const own = tabs(SOFTWARE_GL);
  let complaints: string[] = [];

  beforeAll(async () => {
    served = await serveView();
  });

  afterAll(() => served.close());

  afterEach(async ({ task }) => {
    const said = complaints;
    complaints = [];
    await own.giveBack(task.result?.state === "fail");
    expect(said).toEqual([]);
  });

  return async (options = {}) => {
    // In software, a quarter of the pixels takes a third of the time.
    const usual = { ...USUAL, viewport: { width: 432, height: 448 }, deviceScaleFactor: 0.5, reducedMotion: "reduce" } as const;
    const page = await own.take({ ...usual, ...options });
    page.on("pageerror", (error) => complaints.push(error.message));
    page.on("console", (message) => {
      if (message.type() === "error") complaints.push(message.text());
    });
    await page.goto(served.address);
    await page.waitForFunction(() => "harness" in window);
    return page;
  };
}

export type Pixel = readonly [r: number, g: number, b: number];

/** Pixels of the view's picture, by CSS pixels from its upper left corner. */
export async function picture(page: Page): Promise<(x: number, y: number) => Pixel> {
  const { data, width, channels } = decode(await page.locator("cusp-view").screenshot());
  const density = await page.evaluate(() => devicePixelRatio);
  return (x, y) => {
    const at = channels * (Math.floor(y * density) * width + Math.floor(x * density));
    return [data[at] ?? 0, data[at + 1] ?? 0, data[at + 2] ?? 0];
  };
}

/** Linear light of an sRGB channel. */
const linear = (channel: number): number => {
  const part = channel / 255;
  return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
};

/** Similarity of two colours regardless of brightness: 1 is equal. */
export function likeness(a: Pixel, b: Pixel): number {
  const [u, v] = [a.map(linear), b.map(linear)];
  const dot = u.reduce((sum, value, i) => sum + value * (v[i] ?? 0), 0);
  return dot / (Math.hypot(...u) * Math.hypot(...v));
}

export const heard = (page: Page, type: string): Promise<Heard[]> =>
  page.evaluate((wanted) => window.harness.heard.filter((event) => event.type === wanted), type);

export const forget = (page: Page): Promise<void> =>
  page.evaluate(() => {
    window.harness.heard.length = 0;
  });

export const drawn = (page: Page): Promise<void> => page.evaluate(() => window.harness.drawn());

/** The view's description of its state. */
export const said = (page: Page): Promise<string> =>
  page.locator("cusp-view #state").evaluate((state) => (state.textContent ?? "").replace(/\s+/g, " ").trim());
