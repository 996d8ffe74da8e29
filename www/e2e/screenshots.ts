/** Takes the README's pictures from the built page, and draws its icon for iOS: `npm run screenshots`. */
import { mkdir, readFile, stat } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import { downloaded, drop, launch, open, SOFTWARE_GL, openPanel, state } from "./browser.js";
import { serve } from "./serve.js";

/** Maximum size of a picture, since each clone of the repository includes it. */
const LIMIT_BYTES = 200_000;

interface Shot {
  name: string;
  query?: string;
  options: BrowserContextOptions;
  /** True for the page before a model is open. */
  isEmpty?: boolean;
  /** Takes the picture, if it is not simply one of the page. */
  take?: (page: Page, path: string) => Promise<unknown>;
}

async function orientation(page: Page, path: string): Promise<void> {
  await openPanel(page, "Orient");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  await page.locator("cusp-orientation .pose canvas[data-drawn]").nth(2).waitFor();
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

async function calm(page: Page, path: string): Promise<void> {
  await page.waitForTimeout(1500);
  await page.screenshot({ path });
}

async function findings(page: Page, path: string): Promise<void> {
  await page.locator("button.findings").click();
  await page.waitForTimeout(2000);
  await page.screenshot({ path });
}

/** Three goblets, two of them selected. */
async function plate(page: Page, path: string): Promise<void> {
  const scene = page.locator("cusp-view .scene");
  for (let copies = 2; copies <= 3; copies++) {
    await scene.focus();
    await scene.press("Control+d");
    await page.locator("cusp-model").getByRole("radio", { name: "Move" }).waitFor();
    await page.waitForTimeout(500);
    await state(page, "done");
  }
  await page.waitForTimeout(1500);
  await page.getByRole("radio", { name: "Move" }).click();
  await page.locator("cusp-model").evaluate((panel) => Object.assign(panel, { pressed: [0, 1] }));
  await page.waitForTimeout(1500);
  await page.screenshot({ path });
}

/** The hollow goblet with supports, cut at a layer. */
async function cut(page: Page, path: string): Promise<void> {
  await chooseLayer(page, 0.7);
  await page.locator("cusp-model summary").click();
  await page.getByRole("switch", { name: "Cut at the layer" }).click();
  await page.locator("cusp-model summary").click();
  await page.locator("button.findings").waitFor();
  await page.waitForTimeout(1000);
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
const SMALLER = { ...DESKTOP, deviceScaleFactor: 0.54 };

const SHOTS: readonly Shot[] = [
  { name: "page-wide", options: DESKTOP },
  { name: "page-first", isEmpty: true, options: { ...DESKTOP, colorScheme: "dark" }, take: calm },
  { name: "page-plate", query: "?printer=mars-4-ultra", options: SMALLER, take: plate },
  { name: "page-cut", query: "?printer=mars-4-ultra&wall=1.5&supports=medium", options: { ...SMALLER, colorScheme: "dark" }, take: cut },
  { name: "page-check", options: SMALLER, take: findings },
  { name: "page-phone", options: { viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 }, take: calm },
  { name: "page-orientation", options: { viewport: { width: 1700, height: 1600 } }, take: orientation },
  { name: "page-print-file", query: "?printer=mars-4-ultra", options: { viewport: { width: 960, height: 500 } }, take: printFile },
];

/** Opens the example, at a layer below its middle. */
async function example(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await chooseLayer(page, 0.45);
}

async function chooseLayer(page: Page, part: number): Promise<void> {
  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await slider.fill(String(Math.round(part * Number(await slider.getAttribute("max")))));
}

/** The icon on the home screens of iOS, which reads no SVG and rounds corners itself. */
async function icon(browser: Browser): Promise<void> {
  const at = (name: string): string => fileURLToPath(new URL(`../src/page/${name}`, import.meta.url));
  const page = await browser.newPage({ viewport: { width: 180, height: 180 } });
  const svg = await readFile(at("icon.svg"), "utf8");
  await page.setContent(`<body style="margin: 0">${svg.replace(/ rx="\d+"/, "")}</body>`);
  await page.screenshot({ path: at("icon.png") });
  await page.close();
}

export async function main([folder]: string[]): Promise<void> {
  const into = folder ?? fileURLToPath(new URL("../../docs/", import.meta.url));
  await mkdir(into, { recursive: true });
  const served = await serve();
  const browser = await launch(SOFTWARE_GL);
  try {
    await icon(browser);
    for (const { name, query = "", options, isEmpty = false, take = whole } of SHOTS) {
      const { page } = await open(browser, served.address + query, { reducedMotion: "reduce", ...options });
      if (!isEmpty) await example(page);
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
