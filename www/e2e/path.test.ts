/** The path from a model to its print file: each step is optional, and nothing is lost on the way back. */
import { unzipSync } from "fflate";
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspModel } from "../src/element/panels/model-view.js";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import type { Report } from "../src/api/wire.js";
import { broken } from "./axe.js";
import { downloaded, drop, openPanel, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { floating } from "./solids.js";
import { SOFTWARE_GL } from "./view-pages.js";

const start = pages(SOFTWARE_GL);
const SIDE_MM = 12;
const GAP_MM = 4;
/** The upper cube begins in the air, and all of its lower face hangs. */
const cubes = { name: "cubes.stl", bytes: floating(SIDE_MM, GAP_MM) };
const DESKTOP = { viewport: { width: 1280, height: 800 } };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

async function opened(options: Parameters<typeof start>[1], query = ""): Promise<Page> {
  const page = await start(`?backend=cpu&rays=512${query}`, { ...options, reducedMotion: "reduce" });
  await drop(page, cubes);
  await state(page, "done");
  return page;
}

const row = (page: Page): Locator => page.getByRole("navigation", { name: "Steps" });
const step = (page: Page, name: string): Locator => row(page).getByRole("button", { name: new RegExp(`^${name}`) });
const said = async (page: Page, name: string): Promise<string> => step(page, name).locator(".state").innerText();
const title = (page: Page): Locator => page.locator("cusp-workbench #step-title");

/** Expects the panel of a step, and its title to have the focus. */
async function at(page: Page, name: string): Promise<void> {
  await expect.poll(() => title(page).innerText()).toBe(name);
  expect(await step(page, name).getAttribute("aria-current")).toBe("step");
  expect(await row(page).locator("[aria-current]").count()).toBe(1);
  await expect.poll(() => title(page).evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === it)).toBe(true);
}

const report = (page: Page): Promise<Report> =>
  page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
    if (element.result === null) throw new Error("no result");
    return element.result.report;
  });

const next = (page: Page, name: string): Promise<void> => page.getByRole("button", { name: `Next: ${name}` }).click();
const back = (page: Page): Promise<void> => page.getByRole("button", { name: "Back", exact: true }).click();

interface Manifest {
  layer_files: { z_mm: number; thickness_mm: number; lit_pixels: number }[];
}

/** Lit pixels of the layer of the print file that has this height in it. */
async function litAt(page: Page): Promise<(z_mm: number) => number> {
  const { bytes } = await downloaded(page);
  const { layer_files } = JSON.parse(new TextDecoder().decode(unzipSync(bytes)["manifest.json"])) as Manifest;
  return (z_mm) => layer_files.find((layer) => layer.z_mm >= z_mm)?.lit_pixels ?? 0;
}

test("a first-time user goes from step to step, and the file has supports and a void", async () => {
  const page = await opened(DESKTOP);
  // Those who only want a file have it: nothing is asked.
  expect(await title(page).innerText()).toBe("Slice");
  expect(await said(page, "Slice")).toMatch(/^\d+ layers$/);
  const solid = await litAt(page);
  expect(solid(SIDE_MM + GAP_MM / 2)).toBe(0);

  await step(page, "Turn").click();
  expect(await said(page, "Turn")).toBe("As in the file");
  await page.getByRole("button", { name: "Turn by hand" }).click();
  expect(await page.locator("cusp-model").evaluate((view: CuspModel) => view.tool)).toBe("rotate");
  await page.locator("cusp-view .scene").press("ArrowRight");
  await settled(page);
  await expect.poll(() => said(page, "Turn")).toBe("Turned");

  await next(page, "Check");
  await at(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
  const findings = await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.check?.findings.map(({ code }) => code) ?? []);
  expect(findings.some((code) => code === "island" || code === "loose-body")).toBe(true);
  await expect.poll(() => said(page, "Check")).toMatch(/^(Worth a look|Will fail)$/);

  await next(page, "Hollow");
  await at(page, "Hollow");
  expect(await said(page, "Hollow")).toBe("Solid");
  // The check was of the same plan.
  expect(await said(page, "Check")).toMatch(/^(Worth a look|Will fail)$/);
  await page.getByLabel("Hollow, with walls of").fill("2");
  await settled(page);
  expect(await said(page, "Hollow")).toBe("Walls of 2\u00a0mm");
  expect(await said(page, "Check")).toBe("Not checked");

  await next(page, "Support");
  await at(page, "Support");
  expect(await said(page, "Support")).toBe("None");
  await page.getByLabel("Supports").selectOption("Medium");
  await settled(page);
  const { supported, hollowed } = await report(page);
  expect(await said(page, "Support")).toBe(`Medium, ${supported?.points.length} points`);
  expect(hollowed?.void_ml).toBeGreaterThan(0.5);

  await next(page, "Slice");
  await at(page, "Slice");
  expect(await page.getByRole("button", { name: /^Next/ }).count()).toBe(0);
  const lit = await litAt(page);
  const { lift_mm = 0 } = supported ?? {};
  expect(lit(lift_mm + SIDE_MM + GAP_MM / 2)).toBeGreaterThan(0);
  expect(lit(lift_mm + SIDE_MM / 2)).toBeLessThan(0.8 * solid(SIDE_MM / 2));
});

test("going back loses nothing, not even what cannot be read, and turning to a step changes nothing", async () => {
  const page = await opened(DESKTOP, "&wall=2&supports=medium");
  const before = await page.evaluate(() => location.search);
  const points = (await report(page)).supported?.points;
  for (const name of ["Turn", "Check", "Hollow", "Support", "Slice"]) await step(page, name).click();
  for (const name of ["Support", "Hollow", "Check", "Turn"]) {
    await back(page);
    await at(page, name);
  }
  expect(await page.getByRole("button", { name: "Back", exact: true }).count()).toBe(0);
  await state(page, "done");
  expect(await page.evaluate(() => location.search)).toBe(before);
  expect((await report(page)).supported?.points).toEqual(points);
  await openPanel(page, "Hollow");
  await page.getByLabel("Hollow, with walls of").fill("thick");
  await expect.poll(() => said(page, "Hollow")).toBe("To be corrected");
  await next(page, "Support");
  expect(await page.getByLabel("Supports").inputValue()).toBe("medium");
  await back(page);
  expect(await page.getByLabel("Hollow, with walls of").inputValue()).toBe("thick");
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await page.getByLabel("Hollow, with walls of").inputValue()).toBe("2");
  expect(await said(page, "Hollow")).toBe("Walls of 2\u00a0mm");
});

test("points and holes are placed by hand from their steps, where there is something to place them on", async () => {
  const page = await opened(DESKTOP);
  const tool = (): Promise<string> => page.locator("cusp-model").evaluate((view: CuspModel) => view.tool);
  await step(page, "Hollow").click();
  const holes = page.getByRole("button", { name: "Place holes by hand" });
  expect(await holes.count()).toBe(0);
  await page.getByLabel("Hollow, with walls of").fill("2");
  await settled(page);
  await holes.click();
  expect(await tool()).toBe("drains");
  await page.locator("cusp-model .beside section").waitFor();
  await next(page, "Support");
  await page.getByRole("button", { name: "Place points by hand" }).click();
  await expect.poll(tool).toBe("supports");
  // A step leaves the tool as it is.
  await next(page, "Slice");
  expect(await tool()).toBe("supports");
});

test("a step is at its top, whatever was read of the one before", async () => {
  const page = await opened(DESKTOP);
  const panel = page.locator("cusp-workbench .choices .panel");
  await panel.evaluate((it) => it.scrollTo(0, 1000));
  expect(await panel.evaluate((it) => it.scrollTop)).toBeGreaterThan(0);
  await back(page);
  await at(page, "Support");
  await back(page);
  await next(page, "Support");
  await next(page, "Slice");
  expect(await panel.evaluate((it) => it.scrollTop)).toBe(0);
});

test("by keyboard alone the steps are gone through, and what one does not need is passed by", async () => {
  const page = await opened(DESKTOP);
  const press = async (target: Locator, key = "Enter"): Promise<void> => {
    for (let i = 0; i < 80; i++) {
      if (await target.evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === it)) return page.keyboard.press(key);
      await page.keyboard.press("Tab");
    }
    throw new Error("Tab does not get there");
  };
  await press(step(page, "Turn"));
  await expect.poll(() => title(page).innerText()).toBe("Turn");
  for (const name of ["Check", "Hollow", "Support"]) {
    await press(page.getByRole("button", { name: `Next: ${name}` }));
    await at(page, name);
  }
  await press(page.getByLabel("Supports"), "ArrowDown");
  await settled(page);
  expect((await report(page)).supported?.points.length).toBeGreaterThan(0);
  await press(page.getByRole("button", { name: "Next: Slice" }));
  await at(page, "Slice");
  expect((await report(page)).hollowed).toBeUndefined();
});

test("an accessibility checker finds nothing amiss in any step, and before a model", async () => {
  const empty = await start("", DESKTOP);
  expect(await broken(empty)).toEqual([]);
  expect(await step(empty, "Turn").isDisabled()).toBe(true);
  await step(empty, "Support").click();
  await empty.getByLabel("Supports").selectOption("Light");
  expect(await step(empty, "Check").isDisabled()).toBe(true);
  const page = await opened({ ...DESKTOP, colorScheme: "dark" }, "&wall=2&supports=medium");
  for (const name of ["Turn", "Check", "Hollow", "Support", "Slice"]) {
    await step(page, name).click();
    if (name === "Check") await page.waitForSelector("cusp-findings [data-verdict]");
    expect(await broken(page)).toEqual([]);
  }
});

test("filament printers' slicers hollow and support themselves, and the steps say so", async () => {
  const page = await opened(DESKTOP, "&format=prusa-3mf&wall=2&supports=medium");
  for (const name of ["Hollow", "Support"]) {
    await step(page, name).click();
    expect(await said(page, name)).toBe("–");
    await page.getByText("Slicers of filament printers do this themselves.").waitFor();
    expect(await page.locator("cusp-settings").count()).toBe(0);
  }
});

test("on a phone each step is a sheet, which its button in the row closes, and a tool of the view takes its place", async () => {
  const page = await opened(PHONE);
  await page.locator("cusp-view").waitFor();
  expect(await page.locator(".sheet").count()).toBe(0);
  expect(await row(page).locator("[aria-current]").count()).toBe(0);
  await step(page, "Turn").tap();
  for (const name of ["Check", "Hollow", "Support", "Slice"]) {
    await page.getByRole("button", { name: `Next: ${name}` }).tap();
    await at(page, name);
    expect(await broken(page)).toEqual([]);
  }
  await step(page, "Slice").tap();
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  await step(page, "Turn").tap();
  await page.getByRole("button", { name: "Turn by hand" }).tap();
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  expect(await page.locator("cusp-model").evaluate((view: CuspModel) => view.tool)).toBe("rotate");
});

test.each(["en", "de", "es", "fr", "zh"])("names fit the narrowest screen, in wide letters too: %s", async (locale) => {
  const page = await start(`?backend=cpu&rays=512&locale=${locale}`, { viewport: { width: 320, height: 640 } }, true);
  await drop(page, cubes);
  await state(page, "done");
  const sticking = (): Promise<string[]> =>
    page.evaluate(() => {
      const root = document.querySelector("cusp-workbench")?.shadowRoot;
      const buttons = [...(root?.querySelectorAll<HTMLElement>(".path button, .bar-panels button, .step-foot button, .tab-row button") ?? [])];
      const out = buttons.filter((it) => it.scrollWidth > it.clientWidth || it.getBoundingClientRect().right > innerWidth).map((it) => it.innerText);
      return document.documentElement.scrollWidth > innerWidth ? [...out, "the page"] : out;
    });
  for (const wide of [false, true]) {
    // Between them these are as wide as any font of a system.
    if (wide) {
      await page.evaluate(() => {
        document.documentElement.style.fontSize = "112.5%";
        document.querySelector<HTMLElement>("cusp-workbench")?.style.setProperty("--cusp-font", "monospace");
      });
    }
    expect(await sticking()).toEqual([]);
    await page.locator("cusp-workbench .path button").nth(2).click();
    await page.locator("cusp-workbench .sheet").waitFor();
    expect(await sticking()).toEqual([]);
    await page.locator("cusp-workbench .path button").nth(2).click();
    await expect.poll(() => page.locator("cusp-workbench .sheet").count()).toBe(0);
  }
});
