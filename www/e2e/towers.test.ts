/** The towers that measure a printer: offered, written as the command line writes them, and refused where they tell nothing. */
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Download, Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { drop, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

/** A GOO file: its version, and its magic bytes. */
const GOO = [...new TextEncoder().encode("V3.0"), 0x07, 0x00, 0x00, 0x00, 0x44, 0x4c, 0x50, 0x00];

async function opened(printer: string): Promise<Page> {
  const page = await start(`?backend=cpu&printer=${printer}`);
  await drop(page, { name: "ball.stl", bytes: sphere(10, 48).bytes });
  await state(page, "done");
  return page;
}

const button = (within: Page | Locator): Locator => within.getByRole("button", { name: "Download test towers" });

async function towers(page: Page, within: Locator): Promise<Download> {
  const [file] = await Promise.all([page.waitForEvent("download"), button(within).click()]);
  return file;
}

const cusp = findCusp();

/** The towers that the command line writes. */
async function written(printer: string): Promise<Buffer> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-towers-"));
  try {
    const file = join(folder, "towers");
    execFileSync(cusp ?? "cusp", ["calibrate", "layers", "--printer", printer, "-o", file]);
    return await readFile(file);
  } finally {
    await rm(folder, { recursive: true });
  }
}

// Needs the native cusp: name it in the variable CUSP, or build it in ../target.
test.skipIf(cusp === null)("towers for an untried printer are those of the command line, and the plan stays", async () => {
  const page = await opened("saturn-3");
  const warning = page.locator(".warning", { hasText: "Nobody has told whether the Elegoo Saturn 3 prints layers of several thicknesses" });
  expect(await warning.innerText()).toContain("If they are 0.5 and 1.5\u00a0mm high, the printer takes a thickness for each layer");
  const plan = await page.locator("[part=plan]").innerText();
  const file = await towers(page, warning);
  expect(file.suggestedFilename()).toBe("towers-saturn-3.goo");
  const bytes = await readFile(await file.path());
  expect([...bytes.subarray(0, GOO.length)]).toEqual(GOO);
  expect(bytes.equals(await written("saturn-3"))).toBe(true);
  await state(page, "done");
  expect(await page.locator("[part=plan]").innerText()).toBe(plan);
});

test("towers for a printer that is said to take one thickness, or whose plan is uniform, are in the settings", async () => {
  const page = await opened("photon-mono-m5s");
  const settings = page.locator("cusp-settings");
  expect(await button(page.locator(".warning")).count()).toBe(1);
  await settings.getByText("Uniform", { exact: true }).click();
  await settled(page);
  expect(await page.locator(".warning").count()).toBe(0);
  await settings.getByText("More settings").click();
  expect((await towers(page, settings)).suggestedFilename()).toBe("towers-photon-mono-m5s.pm5s");
  // Without a printer there is nothing to measure.
  await settings.getByLabel("Printer", { exact: true }).selectOption("");
  await settled(page);
  expect(await button(page).count()).toBe(0);
});

test("a format of one thickness refuses towers in words, and the button shows that they are being written", async () => {
  const page = await opened("sl1s");
  // The format decides, so that the towers would tell nothing.
  expect(await button(page.locator(".warning")).count()).toBe(0);
  await page.getByText("More settings").click();
  await page.evaluate(() => {
    const seen: string[] = ((window as unknown as { seen: string[] }).seen = []);
    const root = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-settings")?.shadowRoot;
    const button = root?.querySelector(".towers button");
    const note = (): void => void seen.push(`${button?.getAttribute("aria-busy")} ${button?.textContent?.trim()}`);
    if (button) new MutationObserver(note).observe(button, { attributes: true });
  });
  await button(page).click();
  await state(page, "error");
  const problem = page.getByRole("alert");
  expect(await problem.innerText()).toContain("This print file takes uniform layers only");
  expect(await problem.getByRole("button").allInnerTexts()).toEqual(["Close"]);
  expect(await page.evaluate(() => (window as unknown as { seen: string[] }).seen)).toContain("true Writing test towers…");
  await problem.getByRole("button", { name: "Close" }).click();
  await state(page, "done");
});

test("a printer that the page has fixed is the page's business: no towers", async () => {
  const page = await opened("saturn-3");
  await page.evaluate(() => document.querySelector("cusp-workbench")?.setAttribute("fixed", "printer"));
  await page.getByText("More settings").click();
  expect(await button(page).count()).toBe(0);
});

test("a page without a model gets them through the API, with progress, and may abort", async () => {
  const page = await start();
  const found = await page.evaluate(async () => {
    const slicer = document.querySelector("cusp-workbench")?.slicer;
    if (slicer === undefined) throw new Error("there is no element");
    const aborted = async (): Promise<string> => {
      const abort = new AbortController();
      const options = { printer: "saturn-4-ultra-16k" };
      const writing = slicer.calibrateLayers(options, { signal: abort.signal, onProgress: () => abort.abort() });
      return writing.then(
        () => "it ended",
        (error: Error) => error.name,
      );
    };
    const name = await aborted();
    const stages = new Set<string>();
    const towers = await slicer.calibrateLayers({}, { onProgress: (stage) => stages.add(stage) });
    const { z_mm, height_mm } = towers.report;
    return { aborted: name, name: towers.name, ends: [z_mm[10], z_mm[20], height_mm], last: [...stages].at(-1) };
  });
  expect(found).toMatchObject({ aborted: "AbortError", name: "towers-cusp.zip", last: "masks" });
  expect(found.ends).toEqual([0.5, 1.5, 1.5].map((mm) => expect.closeTo(mm, 6) as number));
});
