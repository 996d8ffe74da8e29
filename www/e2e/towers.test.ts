/** Test towers and test bridges. */
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Download, Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { FACTS } from "../src/api/facts.js";
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

/** A calibration print written by the command line. */
async function written(printer: string, kind = "layers"): Promise<Buffer> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-towers-"));
  try {
    const file = join(folder, "towers");
    execFileSync(cusp ?? "cusp", ["calibrate", kind, "--printer", printer, "-o", file]);
    return await readFile(file);
  } finally {
    await rm(folder, { recursive: true });
  }
}

test.skipIf(cusp === null)("test bridges are those of the command line, and their thicknesses set the print-through", async () => {
  const page = await opened("saturn-3");
  await page.locator("summary", { hasText: "More" }).click();
  await page.locator("summary", { hasText: "Measure print-through" }).click();
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download test bridges" }).click()]);
  expect(file.suggestedFilename()).toBe("bridges-saturn-3.goo");
  expect((await readFile(await file.path())).equals(await written("saturn-3", "cure"))).toBe(true);
  await state(page, "done");
  // Those of a resin with an overcure of 0.03 mm, by the law: its layers above a bridge add up.
  const layers = [1, 2, 3, 4, 6, 8];
  const { penetration_mm } = FACTS.defaults.resin;
  for (const layer_mm of [0.05, 0.1]) {
    for (const count of layers) {
      const fade = Math.exp(-layer_mm / penetration_mm);
      const depth_mm = 0.03 + penetration_mm * Math.log((1 - fade ** count) / (1 - fade));
      await page.getByLabel(`${count} layers of ${layer_mm} mm`).fill((count * layer_mm + depth_mm).toFixed(3));
      await page.keyboard.press("Tab");
    }
  }
  await page.getByText(/Fits to 0(\.00\d)?\smm/u).waitFor();
  await settled(page);
  expect(await page.getByLabel("1 layers of 0.05 mm").inputValue()).not.toBe("");
  expect(await page.getByLabel("8 layers of 0.1 mm").inputValue()).not.toBe("");
  const value = async (label: string): Promise<number> => Number(await page.getByLabel(label).inputValue());
  expect(await value("Print-through: overcure")).toBeCloseTo(0.03, 2);
  expect(await value("Penetration depth")).toBeCloseTo(penetration_mm, 2);
  expect(await value("Retained dose")).toBeCloseTo(1, 1);
});

// Needs the native cusp: name it in the variable CUSP, or build it in ../target.
test.skipIf(cusp === null)("towers for an untried printer are those of the command line, and the plan stays", async () => {
  const page = await opened("saturn-3");
  const warning = page.locator(".warning", { hasText: "It is not confirmed that the Elegoo Saturn 3 prints layers of several thicknesses" });
  expect(await warning.innerText()).toContain("If they are 0.5 and 1.5\u00a0mm high, the printer takes a thickness for each layer");
  // Once the plan is checked, which it says.
  await page.locator("button.findings").waitFor();
  const plan = await page.locator("[part=plan]").innerText();
  const file = await towers(page, warning);
  expect(file.suggestedFilename()).toBe("towers-saturn-3.goo");
  const bytes = await readFile(await file.path());
  expect([...bytes.subarray(0, GOO.length)]).toEqual(GOO);
  expect(bytes.equals(await written("saturn-3"))).toBe(true);
  await state(page, "done");
  expect(await page.locator("[part=plan]").innerText()).toBe(plan);
});
