/** Takes the README's pictures from the built page: `npm run screenshots`. */
import { mkdir, stat } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import type { BrowserContextOptions, Page } from "playwright-core";
import { downloaded, drop, launch, open, SOFTWARE_GL, openPanel, state } from "./browser.js";
import { serve } from "./serve.js";

/** Maximum size of a picture, since each clone of the repository includes it. */
const LIMIT_BYTES = 200_000;

interface Shot {
  name: string;
  query?: string;
  options: BrowserContextOptions;
  /** Takes the picture, if it is not simply one of the page. */
  take?: (page: Page, path: string) => Promise<unknown>;
}

async function orientation(page: Page, path: string): Promise<void> {
  await openPanel(page, "Orient");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  await page.locator("cusp-orientation .pose canvas[data-drawn]").nth(2).waitFor();
  await page.locator("cusp-sphere .disc").first().hover({ position: { x: 60, y: 120 } });
  await page.locator("[part=settings]").screenshot({ path });
}

/** The example's own print file, dropped again. */
async function printFile(page: Page, path: string): Promise<void> {
  await drop(page, { ...(await downloaded(page)), name: "goblet.goo" });
  await page.locator("cusp-print canvas[data-layer]").waitFor();
  // Software draws the surface with a delay.
  await page.waitForTimeout(8000);
  await page.screenshot({ path });
}

async function whole(page: Page, path: string): Promise<void> {
  // Checked once nothing else is to do.
  await page.locator("button.findings").waitFor();
  await page.waitForTimeout(500);
  await page.screenshot({ path });
}

/** The page as a workbench, slightly smaller than on a screen, to limit the size of the picture. */
const DESKTOP = { viewport: { width: 1280, height: 800 }, deviceScaleFactor: 0.58 };

const SHOTS: readonly Shot[] = [
  { name: "page-wide", options: DESKTOP },
  { name: "page-orientation", options: { viewport: { width: 1700, height: 1600 } }, take: orientation },
  { name: "page-print-file", query: "?printer=mars-4-ultra", options: { viewport: { width: 960, height: 500 } }, take: printFile },
];

export async function main([folder]: string[]): Promise<void> {
  const into = folder ?? fileURLToPath(new URL("../../docs/", import.meta.url));
  await mkdir(into, { recursive: true });
  const served = await serve();
  const browser = await launch(SOFTWARE_GL);
  try {
    for (const { name, query = "", options, take = whole } of SHOTS) {
      const { page } = await open(browser, served.address + query, { reducedMotion: "reduce", ...options });
      await page.getByRole("button", { name: "Try the example" }).click();
      await state(page, "done");
      await page.waitForSelector("cusp-view");
      const slider = page.getByRole("slider", { name: "Layer in the view" });
      await slider.fill(String(0.45 * Number(await slider.getAttribute("max"))));
      await page.evaluate(() => document.fonts.ready);
      const path = `${into}/${name}.png`;
      await take(page, path);
      const { size } = await stat(path);
      if (size > LIMIT_BYTES) throw new Error(`${name}.png is ${size} bytes, more than ${LIMIT_BYTES}`);
      console.log(`${name}.png ${size} bytes`);
      await page.context().close();
    }
  } finally {
    await browser.close();
    await served.close();
  }
}
