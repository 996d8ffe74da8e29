/** The path from a model to its print file: each step is optional, and nothing is lost on the way back. */
import { unzipSync } from "fflate";
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspView } from "../src/view/cusp-view.js";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import type { ModelReport, Report } from "../src/api/wire.js";
import { broken } from "./axe.js";
import { downloaded, drop, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { floating } from "./solids.js";

const start = pages();
const SIDE_MM = 12;
const GAP_MM = 4;
/** The upper cube floats, and all of its lower face overhangs. */
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
  await expect.poll(() => title(page).evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === (it.closest("button") ?? it))).toBe(true);
}

const report = (page: Page): Promise<Report> =>
  page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
    if (element.result === null) throw new Error("no result");
    return element.result.report;
  });

/** The only model in the plan. */
async function own(page: Page): Promise<Partial<ModelReport>> {
  return (await report(page)).models[0] ?? {};
}

const next = (page: Page, name: string): Promise<void> => page.getByRole("button", { name: `Next: ${name}` }).click();
const back = (page: Page): Promise<void> => page.getByRole("button", { name: "Back", exact: true }).click();

interface Manifest {
  layer_files: { z_mm: number; thickness_mm: number; lit_pixels: number }[];
}

/** Lit pixels of the print file's layer at a height. */
async function litAt(page: Page): Promise<(z_mm: number) => number> {
  const { bytes } = await downloaded(page);
  const { layer_files } = JSON.parse(new TextDecoder().decode(unzipSync(bytes)["manifest.json"])) as Manifest;
  return (z_mm) => layer_files.find((layer) => layer.z_mm >= z_mm)?.lit_pixels ?? 0;
}

test("a first-time user goes from step to step, each at its top, and the file has supports and a void; going back loses nothing", async () => {
  const page = await opened(DESKTOP);
  // Users who only want a file get it without any step.
  expect(await title(page).innerText()).toBe("Slice");
  expect(await said(page, "Slice")).toMatch(/^\d+ layers$/);
  const solid = await litAt(page);
  expect(solid(SIDE_MM + GAP_MM / 2)).toBe(0);

  await step(page, "Orient").click();
  expect(await said(page, "Orient")).toBe("As in the file");
  await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => void (element.query += "&rotation=0.1,0,0,1"));
  await settled(page);
  await expect.poll(() => said(page, "Orient")).toBe("Turned");

  await step(page, "Check").click();
  await page.waitForSelector("cusp-findings [data-verdict]");
  const findings = await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.check?.models[0]?.findings.map(({ code }) => code) ?? []);
  expect(findings.some((code) => code === "island" || code === "loose-body")).toBe(true);
  await expect.poll(() => said(page, "Check")).toMatch(/^(Worth a look|Will fail)$/);

  await step(page, "Orient").click();
  await next(page, "Hollow");
  await at(page, "Hollow");
  expect(await said(page, "Hollow")).toBe("Solid");
  // The check was of the same plan.
  expect(await said(page, "Check")).toMatch(/^(Worth a look|Will fail)$/);
  await page.getByLabel("Hollow, with walls of").fill("2");
  await settled(page);
  expect(await said(page, "Hollow")).toBe("Walls of 2\u00a0mm");
  // Each plan is checked once the page has nothing else to do.
  await page.locator("cusp-workbench button.findings").waitFor();
  await expect.poll(() => said(page, "Check")).toMatch(/^(Worth a look|Will fail)$/);

  await next(page, "Support");
  await at(page, "Support");
  expect(await said(page, "Support")).toBe("None");
  await page.getByRole("combobox", { name: "Supports" }).selectOption("Medium");
  await settled(page);
  const { supported, hollowed } = await own(page);
  expect(await said(page, "Support")).toBe(`Medium, ${supported?.points.length} points`);
  expect(hollowed?.void_ml).toBeGreaterThan(0.5);

  await next(page, "Check");
  await at(page, "Check");
  await next(page, "Slice");
  await at(page, "Slice");
  expect(await page.getByRole("button", { name: /^Next/ }).count()).toBe(0);
  const lit = await litAt(page);
  const { lift_mm = 0 } = supported ?? {};
  expect(lit(lift_mm + SIDE_MM + GAP_MM / 2)).toBeGreaterThan(0);
  expect(lit(lift_mm + SIDE_MM / 2)).toBeLessThan(0.8 * solid(SIDE_MM / 2));

  const before = await page.evaluate(() => location.search);
  const panel = page.locator("cusp-workbench .choices .panel");
  await panel.evaluate((it) => it.scrollTo(0, 1000));
  expect(await panel.evaluate((it) => it.scrollTop)).toBeGreaterThan(0);
  await back(page);
  await at(page, "Check");
  expect(await panel.evaluate((it) => it.scrollTop)).toBe(0);
  await back(page);
  await at(page, "Support");
  await back(page);
  await at(page, "Hollow");
  // Not even unreadable input.
  await page.getByLabel("Hollow, with walls of").fill("thick");
  await expect.poll(() => said(page, "Hollow")).toBe("To be corrected");
  await back(page);
  await at(page, "Orient");
  await next(page, "Hollow");
  expect(await page.getByLabel("Hollow, with walls of").inputValue()).toBe("thick");
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await page.getByLabel("Hollow, with walls of").inputValue()).toBe("2");
  expect(await page.evaluate(() => location.search)).toBe(before);
  expect((await own(page)).supported?.points).toEqual(supported?.points);
});

test("each plan is checked by itself; one line leads to the findings, which are outlined, and a button remedies the worst", async () => {
  const page = await opened(DESKTOP);
  const line = page.locator("cusp-workbench button.findings");
  await line.waitFor();
  expect(await line.innerText()).toMatch(/^\d+ things? will fail$/);
  // No step is ticked while the check fails.
  expect(await row(page).locator(".badge.done").count()).toBe(0);
  await line.click();
  await expect.poll(() => title(page).innerText()).toBe("Check");
  const outlined = (): Promise<number> => page.locator("cusp-view").evaluate((view: CuspView) => view.places.length);
  await page.locator("cusp-view").waitFor({ state: "attached" });
  await expect.poll(outlined).toBeGreaterThan(0);
  expect((await own(page)).supported).toBeUndefined();
  await page.getByRole("button", { name: "Add supports" }).first().click();
  await settled(page);
  expect((await own(page)).supported?.points.length).toBeGreaterThan(4);
  await line.waitFor();
  await expect.poll(() => line.innerText()).not.toMatch(/will fail/);
  await step(page, "Orient").click();
  await expect.poll(outlined).toBe(0);
});

test("after a download the page says what to do with the file, until the plan changes; the page can be installed", async () => {
  const page = await opened(DESKTOP, "&printer=saturn-3");
  await downloaded(page);
  const card = page.getByRole("status", { name: "Saved file" });
  expect(await card.innerText()).toMatch(/^cubes-cusp\.goo is saved\.\s+Copy it to the printer’s USB stick/);
  await card.getByRole("button", { name: "Download test towers" }).waitFor();
  expect(await broken(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await card.waitFor({ state: "detached" });
  await downloaded(page);
  await card.waitFor();
  await page.getByLabel("Tolerance", { exact: true }).fill("0.08");
  await card.waitFor({ state: "detached" });

  const address = await page.locator("link[rel=manifest]").evaluate((it) => (it as HTMLLinkElement).href);
  const manifest = (await (await page.request.get(address)).json()) as { start_url: string; display: string; icons: { src: string }[] };
  expect([manifest.start_url, manifest.display]).toEqual(["./", "standalone"]);
  for (const { src } of manifest.icons) expect((await page.request.get(new URL(src, address).href)).ok()).toBe(true);
  const touchIcon = await page.locator("link[rel=apple-touch-icon]").evaluate((link) => (link as HTMLLinkElement).href);
  // The size is in the header of the PNG.
  const png = await (await page.request.get(touchIcon)).body();
  expect([png.toString("latin1", 1, 4), png.readUInt32BE(16), png.readUInt32BE(20)]).toEqual(["PNG", 180, 180]);
});

test("by keyboard alone, with Tab and keys, a first visit gets through the steps to the file; its tour takes no focus", async () => {
  const page = await start("?backend=cpu&rays=512", { ...DESKTOP, reducedMotion: "reduce" });
  const press = async (target: Locator, key = "Enter", way: "Tab" | "Shift+Tab" = "Tab"): Promise<void> => {
    for (let i = 0; i < 80; i++) {
      if (await target.evaluate((it) => (it.getRootNode() as ShadowRoot).activeElement === it)) return page.keyboard.press(key);
      await page.keyboard.press(way);
    }
    throw new Error("Tab does not get there");
  };
  await page.evaluate(() => localStorage.removeItem("cusp.tour"));
  await press(page.getByRole("button", { name: "Try the example" }));
  await state(page, "done");
  const tour = page.getByRole("region", { name: "Short tour" });
  await tour.waitFor();
  expect(await broken(page)).toEqual([]);
  // The focus is there for screen readers only; a ring around a name that cannot be used would be confusing.
  expect(await page.evaluate(() => document.querySelector("cusp-workbench")?.shadowRoot?.activeElement?.textContent)).toBe("goblet.stl");
  expect(await page.locator(".model-name").evaluate((it) => getComputedStyle(it).outlineStyle)).toBe("none");
  await page.getByRole("status").filter({ hasText: /layers planned/ }).waitFor();
  await page.keyboard.press("Escape");
  await tour.waitFor({ state: "detached" });
  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await press(slider, "Home");
  await page.keyboard.press("PageUp");
  await expect.poll(() => slider.getAttribute("aria-valuetext")).toMatch(/^Layer 11 of/);
  await press(page.getByRole("tab", { name: "Quality" }), "End");
  await page.waitForSelector("canvas[data-layer]");
  await press(step(page, "Orient"), "Enter", "Shift+Tab");
  await expect.poll(() => title(page).innerText()).toBe("Orient");
  for (const name of ["Hollow", "Support"]) {
    await press(page.getByRole("button", { name: `Next: ${name}` }), "Enter", name === "Hollow" ? "Shift+Tab" : "Tab");
    await at(page, name);
  }
  await press(page.getByRole("combobox", { name: "Supports" }), "ArrowDown");
  await settled(page);
  expect((await own(page)).supported?.points.length).toBeGreaterThan(0);
  for (const name of ["Check", "Slice"]) {
    await press(page.getByRole("button", { name: `Next: ${name}` }));
    await at(page, name);
  }
  expect((await own(page)).hollowed).toBeUndefined();
  const [file] = await Promise.all([page.waitForEvent("download"), press(page.getByRole("button", { name: "Download print file" }))]);
  expect(file.suggestedFilename()).toBe("goblet-cusp.zip");
});

/** Expects the whole element inside the window. */
async function inside(page: Page, it: Locator): Promise<void> {
  const { width, height } = page.viewportSize() ?? { width: 0, height: 0 };
  const box = (await it.boundingBox()) ?? { x: -1, y: -1, width: 0, height: 0 };
  expect(Math.min(box.x, box.y)).toBeGreaterThanOrEqual(0);
  expect(box.x + box.width).toBeLessThanOrEqual(width);
  expect(box.y + box.height).toBeLessThanOrEqual(height);
}

test("by touch on a phone, from a first visit to the file: cards and tour stay in the window, and each step is a sheet, which its button closes", async () => {
  const page = await start("?backend=cpu&rays=512", { ...PHONE, reducedMotion: "reduce" });
  for (const id of ["recent", "saved"]) {
    await page.locator(`[popovertarget=${id}]`).tap();
    await page.locator(`#${id} .panel`).first().waitFor();
    await inside(page, page.locator(`#${id}`));
    await page.keyboard.press("Escape");
  }
  await page.evaluate(() => localStorage.removeItem("cusp.tour"));
  await page.getByRole("button", { name: "Try the example" }).tap();
  await state(page, "done");
  const card = page.locator("cusp-tour .card");
  const bar = await page.locator("cusp-workbench .bar-panels").locator("..").boundingBox();
  for (const step of [1, 2, 3]) {
    await expect.poll(() => card.locator(".quiet").innerText()).toContain(String(step));
    await inside(page, card);
    const box = await card.boundingBox();
    expect((box?.y ?? 0) + (box?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
    await card.getByRole("button").last().tap();
  }
  await expect.poll(() => card.count()).toBe(0);
  expect(await page.locator(".sheet").count()).toBe(0);
  expect(await row(page).locator("[aria-current]").count()).toBe(0);
  await step(page, "Orient").tap();
  for (const name of ["Hollow", "Support", "Check", "Slice"]) {
    await page.getByRole("button", { name: `Next: ${name}` }).tap();
    await at(page, name);
  }
  // As copied from a data sheet.
  await page.getByLabel("Tolerance", { exact: true }).fill("80 µm");
  await settled(page);
  await step(page, "Slice").tap();
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download print file" }).tap()]);
  expect(file.suggestedFilename()).toBe("goblet-cusp.zip");
});

test("one button turns, supports and checks a model, and one step back undoes it", async () => {
  const page = await opened(DESKTOP);
  const query = (): Promise<string> => page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.query);
  const before = await query();
  await step(page, "Check").click();
  await expect.poll(() => said(page, "Check")).toBe("Will fail");
  await page.getByRole("button", { name: "Prepare automatically" }).click();
  await expect.poll(() => title(page).innerText()).toBe("Orient");
  await expect.poll(() => said(page, "Support")).toMatch(/^Medium, \d+ points$/);
  expect(await title(page).innerText()).toBe("Check");
  expect((await own(page)).supported?.unreached).toEqual([]);
  // The loose cube stands on supports now.
  await expect.poll(() => said(page, "Check")).toMatch(/^(Nothing found|Worth a look)$/);
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await query()).toBe(before);
});

test("on a phone, preparing shows the search and then the check", async () => {
  const page = await opened(PHONE);
  await step(page, "Orient").tap();
  await page.getByRole("button", { name: "Prepare automatically" }).tap();
  await expect.poll(() => title(page).innerText()).toBe("Check");
  await settled(page);
  expect((await own(page)).supported?.points.length).toBeGreaterThan(0);
});
