/** Test towers. */
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Download, Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { drop, state } from "./browser.js";
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

/** Towers written by the command line. */
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
  const warning = page.locator(".warning", { hasText: "It is not confirmed that the Elegoo Saturn 3 prints layers of several thicknesses" });
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
