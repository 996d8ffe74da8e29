/** Painting weights with real pointer events: the plan follows the weights, which can be restored from a file. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { drop, sceneBox, settled, SOFTWARE_GL, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages(SOFTWARE_GL);

/** A view that is quick to draw in software. */
const SMALL = { viewport: { width: 1280, height: 500 }, deviceScaleFactor: 0.5 };

const RADIUS = 10;
/** The default maximum thickness. */
const THICKEST_MM = 0.15;
const ball = { name: "ball.stl", bytes: sphere(RADIUS, 48).bytes };

interface Planned {
  z_mm: number[];
  profile: number[];
  bin_mm: number;
  crc32: number | null;
}

const plan = (page: Page): Promise<Planned> =>
  page.evaluate(() => {
    const result = document.querySelector("cusp-workbench")?.result;
    if (result == null) throw new Error("there is no plan");
    const { z_mm, bin_mm, models } = result.report;
    const crc32 = models[0]?.weights_crc32 ?? null;
    return { z_mm, bin_mm, crc32, profile: [...result.profile] };
  });

const weights = (page: Page): Promise<number[] | null> =>
  page.evaluate(() => {
    const found = document.querySelector("cusp-workbench")?.weights ?? null;
    return found === null ? null : [...found];
  });

const brush = (page: Page): Promise<void> => page.getByRole("radio", { name: "Paint" }).click();

/** The highest point of the model on the screen, found by hovering. */
async function top(page: Page): Promise<{ x: number; y: number; z_mm: number }> {
  const view = page.locator("cusp-view");
  await view.scrollIntoViewIfNeeded();
  const box = await sceneBox(view);
  const x = box.x + box.width / 2;
  await view.evaluate((it) =>
    it.addEventListener("cusp-height", (event) => {
      it.dataset["told"] = String((event as CustomEvent<{ z_mm: number | null }>).detail.z_mm);
    }),
  );
  const heightAt = async (y: number): Promise<number | null> => {
    await view.evaluate((it) => delete it.dataset["told"]);
    await page.mouse.move(x, y);
    const told = page.locator("cusp-view[data-told]");
    await told.waitFor({ state: "attached", timeout: 10_000 });
    const z_mm = Number(await told.getAttribute("data-told"));
    return Number.isNaN(z_mm) ? null : z_mm;
  };
  let best = { x, y: 0, z_mm: -1 };
  // Upward from the middle, which is on the ball: every step is reported, and so is leaving the ball.
  for (let y = box.y + box.height / 2; y > box.y; y -= 8) {
    const z_mm = await heightAt(y);
    if (z_mm === null || z_mm < best.z_mm - 1) break;
    if (z_mm > best.z_mm) best = { x, y, z_mm };
  }
  return best;
}

/** A stroke back and forth over a place. */
async function stroke(page: Page, { x, y }: { x: number; y: number }): Promise<void> {
  await page.mouse.move(x - 6, y);
  await page.mouse.down();
  await page.mouse.move(x + 6, y + 2, { steps: 4 });
  await page.mouse.move(x, y, { steps: 4 });
  await page.mouse.up();
}

test("what is painted to matter less is planned thicker there and as before elsewhere; undone and made again, saved and loaded, it is the same plan; what stands out counts when that is switched on", async () => {
  const page = await start("?backend=cpu&rays=512", SMALL);
  await drop(page, ball);
  await state(page, "done");
  await brush(page);
  await page.waitForSelector("cusp-view");
  const before = await plan(page);
  expect(before.crc32).toBeNull();
  await page.getByRole("slider", { name: "Size (mm)" }).fill("95");
  const at = await top(page);
  expect(at.z_mm).toBeGreaterThan(0.95 * 2 * RADIUS);
  await stroke(page, at);
  await expect.poll(() => weights(page)).not.toBeNull();
  await settled(page);
  const painted = await plan(page);
  expect(painted.crc32).not.toBeNull();
  expect(painted.z_mm.length).toBeLessThan(before.z_mm.length);

  // All painted facets are above, so below nothing has changed: neither the profile nor the layers.
  const lowest = await page.evaluate(async () => {
    const slicer = document.querySelector("cusp-workbench");
    const [positions, weights] = [await slicer?.slicer.positions(), slicer?.weights];
    if (positions === undefined || weights == null) throw new Error("nothing is painted");
    let lowest = Infinity;
    for (const [facet, weight] of weights.entries()) {
      if (weight < 1) for (let i = 2; i < 9; i += 3) lowest = Math.min(lowest, positions[9 * facet + i] ?? 0);
    }
    return lowest;
  });
  expect(lowest).toBeGreaterThan(RADIUS);
  const bins = Math.floor(lowest / before.bin_mm);
  expect(painted.profile.slice(0, bins)).toEqual(before.profile.slice(0, bins));
  expect(painted.profile.slice(bins)).not.toEqual(before.profile.slice(bins));
  // Among plans with the same number of layers the planner may take any, so planes may move by less than a layer.
  for (const [i, z_mm] of before.z_mm.entries()) {
    if (z_mm < lowest) expect(Math.abs((painted.z_mm[i] ?? Infinity) - z_mm)).toBeLessThan(THICKEST_MM);
  }

  await page.locator("cusp-view .scene").focus();
  await page.keyboard.press("Control+z");
  await expect.poll(async () => Math.min(...((await weights(page)) ?? []))).toBe(1);
  await settled(page);
  // Weights of 1 give the same plan as no weights.
  expect((await plan(page)).z_mm).toEqual(before.z_mm);
  await page.keyboard.press("Control+Shift+z");
  await settled(page);
  expect((await plan(page)).z_mm).toEqual(painted.z_mm);
  expect(await broken(page)).toEqual([]);

  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Save weights" }).click(),
  ]);
  expect(file.suggestedFilename()).toBe("ball.weights");
  const path = await file.path();

  // A stroke off the model turns the view and paints nothing.
  const kept = await weights(page);
  const view = page.locator("cusp-view");
  const seen = await view.screenshot();
  const box = await view.boundingBox();
  if (box === null) throw new Error("there is no view");
  await page.mouse.move(box.x + 20, box.y + box.height - 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 120, box.y + box.height - 60, { steps: 5 });
  await page.mouse.up();
  expect(await weights(page)).toEqual(kept);
  expect((await view.screenshot()).equals(seen)).toBe(false);

  await drop(page, { ...ball, name: "again.stl" });
  await expect.poll(() => weights(page)).toBeNull();
  await state(page, "done");
  expect((await plan(page)).z_mm).toEqual(before.z_mm);
  await brush(page);
  await page.getByLabel("Load weights").setInputFiles(path);
  await expect.poll(() => weights(page)).toEqual(kept);
  await settled(page);
  const reloaded = await plan(page);
  expect(reloaded.z_mm).toEqual(painted.z_mm);
  expect(reloaded.crc32).toBe(painted.crc32);

  // A new model has no weights.
  await drop(page, { name: "other.stl", bytes: sphere(RADIUS, 24).bytes });
  await expect.poll(() => weights(page)).toBeNull();
  await state(page, "done");
  const plain = await plan(page);
  await brush(page);
  await page.getByLabel("Load weights").setInputFiles(path);
  await page.getByText(/ is of another model/).waitFor();
  await page.getByLabel("Load weights").setInputFiles({ name: "ball.weights", mimeType: "application/octet-stream", buffer: Buffer.from("nothing of the kind") });
  await page.getByText("ball.weights holds no weights").waitFor();
  expect(await weights(page)).toBeNull();

  // Saliency counts in the plan when switched on.
  await page.getByRole("checkbox", { name: "What stands out matters more" }).check();
  await settled(page);
  expect((await plan(page)).z_mm.length).toBeLessThan(plain.z_mm.length);
  expect(new URL(page.url()).searchParams.get("saliency")).toBe("on");
});
