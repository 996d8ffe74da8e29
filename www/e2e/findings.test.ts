/** Findings on the page: their kinds and places, and their updates with the model. */
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { promisify } from "node:util";
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspView } from "../src/view/cusp-view.js";
import type { ModelPrintability } from "../src/api/index.js";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { broken } from "./axe.js";
import { drop, maskOf, openPanel, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { cup, prism, sphere } from "./solids.js";

const start = pages();
const mug = { name: "mug.stl", bytes: cup(10, 8, 1.5) };

async function opened(): Promise<Page> {
  const page = await start("?backend=cpu");
  await drop(page, mug);
  await state(page, "done");
  await openPanel(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
  return page;
}

const verdict = (page: Page): Promise<string | null> => page.locator("cusp-findings [data-verdict]").getAttribute("data-verdict");

test("a cup is found, chosen by click or key it is shown and marked, is judged by the limits of a shop, and upside down it is none", async () => {
  const page = await opened();
  expect(await verdict(page)).toBe("review");
  const [finding] = await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.check?.models[0]?.findings ?? []);
  expect(finding?.code).toBe("cup");
  const found = page.getByRole("button", { name: /^A hollow of/ });
  expect(await found.count()).toBe(1);
  await found.focus();
  await page.keyboard.press("Enter");
  expect(await found.getAttribute("aria-pressed")).toBe("true");
  await page.keyboard.press("Escape");
  expect(await found.getAttribute("aria-pressed")).toBe("false");
  await found.click();
  expect(await broken(page)).toEqual([]);
  await openPanel(page, "Mask");
  await maskOf(page, finding?.layers[0] ?? -1);
  // Marked in the mask, in the chart, and in the view.
  expect(await page.locator("cusp-mask canvas[data-marked]").count()).toBe(1);
  expect(await page.locator("cusp-mask canvas").getAttribute("data-places")).toBe("1");
  // The film pulls at its ring with some tenths of a newton.
  const pull = page.locator("cusp-mask dl div", { hasText: "Pull of the film" }).locator("dd");
  expect(Number.parseFloat(await pull.innerText())).toBeGreaterThan(0.1);
  const [band, plot] = await Promise.all([page.locator("cusp-chart .range").boundingBox(), page.locator("cusp-chart .u-over").boundingBox()]);
  // The model is 8 mm high; the hollow begins 1.5 mm above the plate.
  expect((band?.height ?? 0) / (plot?.height ?? 1)).toBeCloseTo(6.5 / 8, 1);
  expect(await page.locator("cusp-view").evaluate((view: CuspView) => view.marks[0]?.bounds_mm[1][2])).toBeCloseTo(8, 1);

  // With a shop's limits, the page receives the verdict.
  await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
    element.addEventListener("cusp-check", ({ detail }) => void (document.body.dataset["told"] = detail.verdict));
    element.limits = { severity: { cup: "reject" } };
  });
  const told = (): Promise<string | undefined> => page.evaluate(() => document.body.dataset["told"]);
  await expect.poll(told).toBe("reject");
  await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => (element.limits = { cup_mm2: 1000 }));
  await expect.poll(told).toBe("ok");
  // Checked even without a panel.
  await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
    element.limits = {};
    element.query = "rotation=1,0,0,0";
  });
  await settled(page);
  await expect.poll(() => page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.check?.models[0]?.findings.map(({ code }) => code))).not.toContain("cup");
  await expect.poll(() => found.count()).toBe(0);
  expect(await page.locator("cusp-chart .range").isVisible()).toBe(false);
});

test("on a plate a finding is marked on each copy that stands alike, and warnings name their model", async () => {
  const page = await start("?backend=cpu&printer=mars-4-ultra&rays=512");
  // A block without one side.
  const block = prism(12, 8).bytes.slice(0, -50);
  const facets = new DataView(block.buffer);
  facets.setUint32(80, facets.getUint32(80, true) - 1, true);
  await drop(page, mug, { name: "block.stl", bytes: block });
  await state(page, "done");
  await page.getByRole("button", { name: "One more: Copies of mug.stl" }).click();
  await settled(page);
  expect(await page.locator(".warning b").allTextContents()).toContain("block.stl");
  await openPanel(page, "Check");
  const found = page.locator("cusp-findings button.finding").first();
  await found.click();
  expect(await found.getAttribute("aria-pressed")).toBe("true");
  const places = (): Promise<number[]> => page.locator("cusp-view").evaluate((view: CuspView) => view.marks.map(({ at_mm: [x] }) => x));
  expect(new Set(await places()).size).toBe(2);
  await found.press("Escape");
  expect(await places()).toEqual([]);
});

test("a support is added at the place of a finding, of a model alone and of one on a plate; undo takes it back", async () => {
  const points = (page: Page): Promise<number[][]> =>
    page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models.at(-1)?.supported?.points.map(({ at_mm }) => at_mm) ?? []);
  for (const others of [[], [mug]]) {
    const page = await start("?backend=cpu&printer=mars-4-ultra&rays=512&supports=medium");
    await drop(page, ...others, { name: "box.stl", bytes: prism(12, 6).bytes });
    await state(page, "done");
    // One point at a corner holds little of the box.
    if (others.length > 0) await page.getByRole("button", { name: "box.stl", exact: true }).click();
    await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => (element.query = `${element.query}&points=-5,-5,0,,1`));
    await settled(page);
    await openPanel(page, "Check");
    await page.waitForSelector("cusp-findings [data-verdict]");
    await expect.poll(() => points(page)).toEqual([[-5, -5, 0]]);
    await page.getByRole("button", { name: /^Surfaces of/ }).last().click();
    await page.getByRole("button", { name: "Add a support here" }).click();
    await settled(page);
    await expect.poll(async () => (await points(page)).length).toBe(2);
    // Both are on the underside.
    for (const [x = NaN, y = NaN, z = NaN] of await points(page)) {
      expect(Math.max(Math.abs(x), Math.abs(y))).toBeLessThanOrEqual(6);
      expect(z).toBeCloseTo(0, 3);
    }
    await page.getByRole("button", { name: "Undo" }).first().click();
    await expect.poll(() => points(page)).toEqual([[-5, -5, 0]]);
  }
});

const program = process.env["CUSP"];

/** Runs work in a folder of its own, which is removed afterwards. */
async function inFolder(work: (folder: string) => Promise<void>): Promise<void> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-findings-"));
  try {
    await work(folder);
  } finally {
    await rm(folder, { recursive: true });
  }
}

test.skipIf(program === undefined)("the page finds what the command line does", async () => {
  const page = await opened();
  const check = await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.check);
  await inFolder(async (folder) => {
    const model = join(folder, mug.name);
    await writeFile(model, mug.bytes);
    const { stdout } = await promisify(execFile)(program ?? "", ["check", model, "--json"]);
    const told = JSON.parse(stdout) as { plates: { models: ModelPrintability[] }[] };
    // As JSON, which turns undefined into null.
    const plain = ({ verdict, findings, counts, bodies, peel }: Partial<ModelPrintability>): unknown =>
      JSON.parse(JSON.stringify({ verdict, findings: findings?.map((it) => ({ ...it, joins_layer: it.joins_layer ?? null })), counts, bodies, peel }));
    expect(plain(check?.models[0] ?? {})).toEqual(plain(told.plates[0]?.models[0] ?? {}));
  });
});

test.skipIf(program === undefined)("supports of a file are read as parts of the model by a button, and undo takes it back", async () => {
  await inFolder(async (folder) => {
    const [ball, held] = ["ball.stl", "held.stl"].map((name) => join(folder, name)) as [string, string];
    await writeFile(ball, sphere(6, 32).bytes);
    await promisify(execFile)(program ?? "", ["plan", ball, "--supports", "medium", "--export", held]);
    const page = await start("?backend=cpu");
    await drop(page, { name: "held.stl", bytes: await readFile(held) });
    await settled(page);
    const supported = (): Promise<boolean> =>
      page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models[0]?.supported != null);
    expect(await supported()).toBe(true);
    // What holds the model stays when it is prepared.
    const query = (): Promise<string> => page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.query);
    const before = await query();
    await page.getByRole("button", { name: "Prepare automatically" }).click();
    await page.waitForSelector("cusp-findings [data-verdict]");
    expect(await query()).toBe(before);
    await page.getByRole("button", { name: "They are parts of the model" }).click();
    await expect.poll(supported).toBe(false);
    await settled(page);
    await page.keyboard.press("Control+z");
    await expect.poll(supported).toBe(true);
  });
});
