/** A real headless Chromium, and the actions of a user on the page. */
import { readFile } from "node:fs/promises";
import { chromium, type Browser, type BrowserContextOptions, type Download, type Locator, type Page } from "playwright-core";
import { program } from "./program.js";

/** The element of the page or of a shop. */
const ELEMENT = ":is(cusp-workbench, cusp-slicer)";

const FLAGS = [
  "--no-sandbox",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** Without the flags below there is no software GPU, which would also compose the page and take more than half of the time of a plan. */
const NO_GPU = "--disable-software-rasterizer";

/** WebGPU by a software adapter, so that the page behaves as on a machine with a GPU. */
export const SOFTWARE_GPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"];

/** WebGL in software, without a GPU. */
export const SOFTWARE_GL = ["--enable-unsafe-swiftshader"];

/** The browser named by CHROMIUM, or the first of its usual names on PATH. */
function executable(): string {
  const found = program(["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"], "CHROMIUM");
  if (found === null) throw new Error("no Chromium on PATH: install one, or name it in the variable CHROMIUM");
  return found;
}

/** @param flags additional flags of the browser */
export function launch(flags: readonly string[] = [NO_GPU]): Promise<Browser> {
  return chromium.launch({ executablePath: executable(), args: [...FLAGS, ...flags] });
}

export interface Opened {
  page: Page;
  /** Requested URLs outside the page's origin. There must be none. */
  strangers: string[];
  /** Exceptions and logged errors of the page. */
  complaints: string[];
}

/** Default options of a browser context. */
export const USUAL = {
  locale: "en-GB",
  viewport: { width: 1280, height: 900 },
  // A service worker would answer requests that the tests intercept.
  serviceWorkers: "block",
} as const satisfies BrowserContextOptions;

/** A fresh page at `address`, with foreign requests and errors recorded. */
export async function open(browser: Browser, address: string, options: BrowserContextOptions = {}): Promise<Opened> {
  const context = await browser.newContext({ ...USUAL, ...options });
  return visit(await context.newPage(), address);
}

/** Opens `address` in a tab. */
export async function visit(page: Page, address: string): Promise<Opened> {
  const strangers: string[] = [];
  const complaints: string[] = [];
  const { origin } = new URL(address);
  page.on("request", (request) => {
    const { origin: asked, protocol } = new URL(request.url());
    if (asked !== origin && protocol !== "blob:" && protocol !== "data:") strangers.push(request.url());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") complaints.push(message.text());
  });
  await page.goto(address);
  await page.waitForSelector(`${ELEMENT}[state=empty]`);
  // The tour of a first visit would cover the page.
  await page.evaluate(() => localStorage.setItem("cusp.tour", "shown"));
  return { page, strangers, complaints };
}

export interface DroppedFile {
  name: string;
  bytes: Uint8Array;
}

/** Drops files on the page, like a file manager, in place of open models. Returns the page's clock at the drop, in ms. */
export const drop = (page: Page, ...files: DroppedFile[]): Promise<number> => dropAt(page, ".drop-veil .replace", files);

/** The same beside the open models. */
export const dropBeside = (page: Page, ...files: DroppedFile[]): Promise<number> => dropAt(page, ".drop-veil .add", files);

/** @param place selector of an element that the page shows during the drag */
async function dropAt(page: Page, place: string, files: readonly DroppedFile[]): Promise<number> {
  // Serves the bytes to the page; as base64 in a message, a large model would take seconds.
  const address = new URL("e2e-drop/", page.url()).href;
  await page.route(`${address}*`, (route) => {
    const file = files[Number(route.request().url().slice(address.length))];
    return route.fulfill({ body: Buffer.from(file?.bytes ?? []), contentType: "application/octet-stream" });
  });
  const at = await page.evaluate(
    async ([from, names, element, place]) => {
      const transfer = new DataTransfer();
      for (const [index, name] of names.entries()) {
        const answer = await fetch(from + String(index));
        transfer.items.add(new File([await answer.arrayBuffer()], name));
      }
      const target = document.querySelector(element);
      if (target === null) throw new Error("there is no page");
      const start = performance.now();
      for (const type of ["dragenter", "dragover", "drop"]) {
        const { x = 0, y = 0, width = 0, height = 0 } = document.querySelector(place)?.getBoundingClientRect() ?? {};
        const [clientX, clientY] = [x + width / 2, y + height / 2];
        target.dispatchEvent(
          new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true, composed: true, clientX, clientY }),
        );
      }
      return start;
    },
    [address, files.map(({ name }) => name), ELEMENT, place] as const,
  );
  await page.unroute(`${address}*`);
  return at;
}

export async function state(page: Page, wanted: string, timeout = 30_000): Promise<void> {
  await page.waitForSelector(`${ELEMENT}[state=${wanted}]`, { timeout });
}

/** Waits, after a change of settings, until the plan shown matches them. */
export async function settled(page: Page): Promise<void> {
  // A change makes the element busy before the next frame.
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
  await state(page, "done");
}

export async function layers(page: Page): Promise<number> {
  return Number(await page.locator("[data-layers]").getAttribute("data-layers"));
}

/** The element's text with white space normalised, which makes thin and no-break spaces plain. */
export async function words(page: Page): Promise<string> {
  return (await page.locator(":is(cusp-workbench .bench, cusp-slicer .slicer)").innerText()).replace(/\s+/g, " ");
}

/** Opens a panel of the page: a step, a tab, or the button of a sheet on a narrow page. */
export async function openPanel(page: Page, name: string): Promise<void> {
  await page.getByRole("tab", { name }).or(page.locator("nav").getByRole("button", { name })).click();
}

/** The part of a 3-D view that nothing covers; the scene is in its middle. */
export async function sceneBox(view: Locator): Promise<{ x: number; y: number; width: number; height: number }> {
  const box = await view.boundingBox();
  if (box === null) throw new Error("there is no view");
  const aside = await view.locator(".scene").evaluate((it) => parseFloat(getComputedStyle(it).paddingInlineEnd));
  return { ...box, width: box.width - aside };
}

/** Waits until the mask of this layer is shown, counted from 0. */
export async function maskOf(page: Page, layer: number): Promise<void> {
  await page.waitForSelector(`canvas[data-layer="${layer}"]`);
}

export async function download(page: Page): Promise<Download> {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: /Download print file/ }).click(),
  ]);
  return file;
}

/** The print file saved by the page. */
export async function downloaded(page: Page): Promise<{ name: string; bytes: Buffer }> {
  const file = await download(page);
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

/** Searches for a printer, and chooses the first one found. */
export async function choosePrinter(page: Page, text: string): Promise<void> {
  const field = page.getByRole("combobox", { name: /^(Printer|Your printer)$/ });
  await field.click();
  await field.pressSequentially(text);
  await field.press("Enter");
}
