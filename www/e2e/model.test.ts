/** The 3-D view in the page: the drawing follows the model, and the plan follows actions in the view. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspView } from "../src/view/cusp-view.js";
import { downloaded, drop, layers, openPanel, settled, SOFTWARE_GL, state, type DroppedFile } from "./browser.js";
import { pages } from "./pages.js";
import { cup, prism, sphere } from "./solids.js";

const start = pages(SOFTWARE_GL);

/** A view that is quick to draw in software. */
const SMALL = { viewport: { width: 1280, height: 500 }, deviceScaleFactor: 0.5 };
const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const block = { name: "block.stl", bytes: prism(12, 8).bytes };

const said = (page: Page): Promise<string> =>
  page.locator("cusp-view #state").evaluate((it) => (it.textContent ?? "").replace(/\s+/g, " ").trim());

test("held, the model is previewed as it turns; let go, or turned by keyboard, it is planned; a button turns it back", async () => {
  const page = await start("?backend=cpu&rays=512", SMALL);
  await drop(page, block);
  await state(page, "done");
  await page.waitForSelector("cusp-view .scene");
  const upright = await layers(page);
  await page.getByRole("radio", { name: "Turn" }).click();
  await page.locator("cusp-view .scene").focus();
  for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowUp");
  await settled(page);
  await expect.poll(() => layers(page)).not.toBe(upright);
  const { searchParams } = new URL(page.url());
  const rotation = (searchParams.get("rotation") ?? "").split(",").map(Number);
  expect(Math.hypot(...rotation)).toBeCloseTo(1, 4);
  // By 15° about one axis.
  expect(Math.abs(rotation[3] ?? 0)).toBeCloseTo(Math.cos(Math.PI / 24), 4);
  await expect.poll(() => said(page)).toMatch(/ × 10\.8 mm, /);

  await page.getByRole("button", { name: "As in the file" }).click();
  await settled(page);
  expect(await layers(page)).toBe(upright);
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(false);

  const tell = (rotation: number[], final: boolean): Promise<void> =>
    page.evaluate(
      ([rotation, final]) => {
        const root = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-model")?.shadowRoot;
        root?.querySelector("cusp-view")?.dispatchEvent(new CustomEvent("cusp-rotate", { detail: { rotation, final } }));
      },
      [rotation, final] as const,
    );
  await tell([Math.SQRT1_2, 0, 0, Math.SQRT1_2], false);
  await expect.poll(() => layers(page)).not.toBe(upright);
  // A preview is not a task: the element is not busy, and no plan was made.
  await state(page, "done");
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(false);
  const previewed = await layers(page);
  await tell([Math.SQRT1_2, 0, 0, Math.SQRT1_2], true);
  await settled(page);
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(true);
  // Planned from the same facets; rays only omit facets inside the model.
  expect(Math.abs((await layers(page)) - previewed)).toBeLessThan(0.02 * previewed);
});

test("beside the chart, heights are where the chart has them", async () => {
  const page = await start("?backend=cpu&rays=512", { viewport: { width: 1280, height: 800 } });
  await drop(page, ball);
  await state(page, "done");
  const beside = page.getByRole("switch", { name: "Beside the profile" });
  await page.locator("cusp-model summary").click();
  await expect.poll(() => beside.isVisible()).toBe(true);
  expect(await beside.isChecked()).toBe(false);
  /** Upper edge and plate of the model on the screen, and those of the chart's plot. */
  const edges = (): Promise<number[]> =>
    page.evaluate(async () => {
      const root = document.querySelector("cusp-workbench")?.shadowRoot;
      const panel = root?.querySelector("cusp-model")?.shadowRoot;
      const view = panel?.querySelector("cusp-view");
      const over = root?.querySelector("cusp-chart")?.shadowRoot?.querySelector(".u-over")?.getBoundingClientRect();
      const aligned = panel?.querySelector<HTMLElement>("[role=switch]");
      if (!view || !over || !aligned) throw new Error("there is no view beside a chart");
      const frame = new Promise<{ top_px: number; bottom_px: number }>((resolve) => {
        // It reports the positions of heights once aligned again.
        const hear = (event: Event): void => {
          const { detail } = event as CustomEvent<{ top_px: number; bottom_px: number } | null>;
          if (detail === null) return aligned.click();
          view.removeEventListener("cusp-frame", hear);
          resolve(detail);
        };
        view.addEventListener("cusp-frame", hear);
        aligned.click();
      });
      const { top } = view.getBoundingClientRect();
      const { top_px, bottom_px } = await frame;
      return [top + top_px - over.top, top + bottom_px - over.bottom];
    });
  for (const distance of await edges()) expect(Math.abs(distance)).toBeLessThan(1);
});

test("a copy on the plate is moved by keyboard and by pointer; one that overlaps another is told, and arranging puts it back", async () => {
  const page = await start("?printer=mars-4-ultra&rays=512", SMALL);
  await drop(page, ball, block);
  await state(page, "done");
  const moved = page.locator("cusp-plate").getByText("Copies stand where they were moved.");
  await page.getByRole("radio", { name: "Move" }).click();
  const scene = page.locator("cusp-view .scene");
  await scene.focus();
  await scene.press("ArrowDown");
  await moved.waitFor();
  await settled(page);
  // To the right, into the block.
  for (let i = 0; i < 2; i++) await scene.press("Shift+ArrowRight");
  await state(page, "error");
  expect(await page.getByRole("alert").innerText()).toContain("Copy 1 of model 1 and copy 1 of model 2 overlap on plate 1");
  await page.getByRole("button", { name: "Arrange", exact: true }).click();
  await state(page, "done");
  await expect.poll(() => moved.count()).toBe(0);

  await page.getByRole("radio", { name: "Move" }).click();
  const { x, y, width, height } = (await page.locator("cusp-view canvas").boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  // Only the camera knows the ball's exact position. A press next to it turns the view.
  let isMoved = false;
  const parts = [0.25, 0.35, 0.45, 0.55, 0.65];
  for (const [across, down] of parts.flatMap((down) => parts.map((across) => [across, down] as const))) {
    const at = { x: x + across * width, y: y + down * height };
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x, at.y + 12, { steps: 4 });
    await page.mouse.up();
    isMoved = (await moved.count()) + (await page.getByRole("alert").count()) > 0;
    if (isMoved) break;
  }
  expect(isMoved).toBe(true);
});

test("the best orientations have pictures, and a print file its surface", async () => {
  const page = await start("?printer=mars-4-ultra&height=5", SMALL);
  await drop(page, block);
  await state(page, "done");
  const { bytes } = await downloaded(page);
  await openPanel(page, "Orient");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  const pictures = page.locator("cusp-orientation .pose canvas[data-drawn]");
  await expect.poll(() => pictures.count()).toBe(3);
  const drawn = await pictures.evaluateAll((all) => all.map((it) => (it as HTMLCanvasElement).toDataURL()));
  const blank = await page.evaluate(() => Object.assign(document.createElement("canvas"), { width: 256, height: 256 }).toDataURL());
  expect(drawn).not.toContain(blank);
  await drop(page, { name: "block.goo", bytes });
  await page.locator("cusp-print cusp-view canvas").waitFor();
});

test("the thickness of walls is shown by keyboard, and ends where other colours are asked for", async () => {
  const page = await start("?backend=cpu&rays=512", SMALL);
  await drop(page, { name: "mug.stl", bytes: cup(10, 8, 1.5) });
  await state(page, "done");
  await openPanel(page, "Check");
  const toggle = page.getByRole("switch", { name: "Show wall thickness" });
  await toggle.focus();
  await page.keyboard.press("Space");
  const scale = page.locator("cusp-view .legend.walls");
  await scale.waitFor();
  expect((await scale.innerText()).replaceAll(/\s+/g, " ")).toBe("Wall thickness (mm) 0 1 2 3 ≥ 4 Thinner than 0.4 mm");
  expect(await page.locator("cusp-findings .legend.walls").isVisible()).toBe(false);
  expect(await page.locator("cusp-view").evaluate((view: CuspView) => Math.min(...(view.walls?.thickness_mm ?? [])))).toBeCloseTo(1.5, 3);
  // It stays when another panel is looked at.
  await openPanel(page, "Mask");
  expect(await scale.isVisible()).toBe(true);
  await page.locator("cusp-model summary").click();
  await page.getByRole("switch", { name: "As printed" }).click();
  await scale.waitFor({ state: "detached" });
  await openPanel(page, "Check");
  expect(await toggle.isChecked()).toBe(false);
});

test("on a plate the walls are those of the selected model, which is seen alone meanwhile", async () => {
  const page = await start("?backend=cpu&printer=mars-4-ultra", SMALL);
  const mug = (name: string, wall_mm: number): DroppedFile => ({ name, bytes: cup(10, 8, wall_mm) });
  await drop(page, mug("thick.stl", 1.5), mug("thin.stl", 0.75));
  await state(page, "done");
  await openPanel(page, "Check");
  const toggle = page.getByRole("switch", { name: "Show wall thickness" });
  const view = page.locator("cusp-view");
  const copies = (): Promise<number> => view.evaluate((view: CuspView) => view.copies.length);
  // Their findings are on the plate, where no model stands meanwhile.
  const outlined = (): Promise<boolean> => view.evaluate((view: CuspView) => view.places.length > 0);
  await expect.poll(copies).toBe(2);
  await expect.poll(outlined).toBe(true);
  await toggle.check();
  await page.locator("cusp-view .legend.walls").waitFor();
  expect(await copies()).toBe(0);
  expect(await outlined()).toBe(false);
  const thinnest = (): Promise<number> => view.evaluate((view: CuspView) => Math.min(...(view.walls?.thickness_mm ?? [0])));
  const first_mm = await thinnest();
  await page.locator("cusp-plate button.name", { hasText: first_mm > 1 ? "thin.stl" : "thick.stl" }).click();
  await expect.poll(thinnest).toBeCloseTo(first_mm > 1 ? 0.75 : 1.5, 3);
  await toggle.uncheck();
  await expect.poll(copies).toBe(2);
});

test("on the smallest phone an open sheet leaves the view its room, and has some itself", async () => {
  const page = await start("", { viewport: { width: 320, height: 640 }, hasTouch: true, isMobile: true });
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view canvas");
  for (const name of ["Support", "Profile"]) {
    await page.locator("nav").getByRole("button", { name }).tap();
    await page.locator(".sheet").getByRole("heading", { name, level: 2 }).waitFor();
    const height = async (selector: string): Promise<number> => (await page.locator(selector).boundingBox())?.height ?? 0;
    expect(await height("cusp-view")).toBeGreaterThan(165);
    expect(await height(".sheet .panel")).toBeGreaterThan(110);
    expect(await page.evaluate(() => document.documentElement.scrollHeight - innerHeight)).toBe(0);
  }
});

/** Setting of the page, as in its address. */
async function setting(page: Page, name: string): Promise<string> {
  await expect.poll(() => new URL(page.url()).searchParams.get(name), { message: name }).not.toBeNull();
  return new URL(page.url()).searchParams.get(name) ?? "";
}

test("a model is turned, scaled and mirrored by typed numbers, and undo takes it back", async () => {
  const page = await start("?backend=cpu&rays=512", { viewport: { width: 1280, height: 800 } });
  await drop(page, block);
  await state(page, "done");
  await page.getByRole("radio", { name: "Scale" }).click();
  const type = async (label: string, text: string): Promise<void> => {
    const field = page.locator("cusp-model .fields").getByLabel(label);
    await field.fill(text);
    await field.press("Enter");
    await settled(page);
  };
  await type("Z (mm)", "4");
  expect(Number(await setting(page, "height"))).toBeCloseTo(4, 3);
  await expect.poll(() => page.locator("cusp-model .fields").getByLabel("Scale (%)").inputValue()).toBe("50");
  await type("Scale (%)", "75");
  expect(Number(await setting(page, "height"))).toBeCloseTo(6, 3);
  await page.getByRole("radio", { name: "Turn" }).click();
  await type("Z (°)", "30");
  const [x = 1, y = 1, z = 0] = (await setting(page, "rotation")).split(",").map(Number);
  for (const [part, expected] of [[x, 0], [y, 0], [z, Math.sin(Math.PI / 12)]] as const) expect(part).toBeCloseTo(expected, 4);
  await page.getByRole("button", { name: "Mirror" }).click();
  await expect.poll(async () => Number((await setting(page, "rotation")).split(",")[2])).toBeCloseTo(-z, 4);
  await settled(page);
  const isMirrored = (): Promise<boolean | undefined> => page.evaluate(() => document.querySelector("cusp-workbench")?.model?.reading.mirrored);
  expect(await isMirrored()).toBe(true);
  expect(Number(await setting(page, "height"))).toBeCloseTo(6, 3);
  await page.getByRole("button", { name: "Undo" }).click();
  await expect.poll(async () => (await isMirrored()) ?? false).toBe(false);
});

test("copies are selected in the view, duplicated, moved together and removed, by pointer, keys and menu", async () => {
  const page = await start("?printer=mars-4-ultra&rays=512", { viewport: { width: 1280, height: 800 } });
  await drop(page, block);
  await state(page, "done");
  const scene = page.locator("cusp-view .scene");
  const view = page.locator("cusp-view");
  const chosen = (): Promise<readonly number[]> => view.evaluate((view: CuspView) => view.chosen);
  const places = (): Promise<readonly (readonly number[])[]> => view.evaluate((view: CuspView) => view.copies.map(({ x_mm, y_mm }) => [x_mm, y_mm]));
  const copies = async (): Promise<number> => (await places()).length;
  await scene.focus();
  await scene.press("Control+d");
  await expect.poll(copies).toBe(2);
  await settled(page);
  // Only the camera knows where they stand: presses of the secondary button select the copy below them.
  const menu = page.getByRole("menu");
  const box = (await page.locator("cusp-view canvas").boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  const found = new Map<number, { x: number; y: number }>();
  for (const across of [0.3, 0.35, 0.4, 0.45, 0.5, 0.55]) {
    const at = { x: box.x + across * box.width, y: box.y + 0.55 * box.height };
    await page.mouse.click(at.x, at.y, { button: "right" });
    await menu.waitFor();
    const [place = -1] = await chosen();
    if (!found.has(place)) found.set(place, at);
    await page.keyboard.press("Escape");
    await menu.waitFor({ state: "hidden" });
  }
  expect([...found.keys()].toSorted((a, b) => a - b)).toEqual([0, 1]);
  const [first = { x: 0, y: 0 }, second = { x: 0, y: 0 }] = [found.get(0), found.get(1)];
  await page.mouse.click(first.x, first.y);
  expect(await chosen()).toEqual([0]);
  await page.keyboard.down("Shift");
  await page.mouse.click(second.x, second.y);
  await page.keyboard.up("Shift");
  await expect.poll(chosen).toEqual([0, 1]);
  const xs = async (): Promise<number[]> => (await places()).map(([x = 0]) => x);
  const before = await xs();
  await page.getByRole("radio", { name: "Move" }).click();
  await scene.focus();
  await scene.press("ArrowRight");
  await expect.poll(xs).toEqual(before.map((x) => Math.round((x + 1) / 0.05) * 0.05));
  await settled(page);
  const field = page.locator("cusp-model .fields").getByLabel("Y (mm)");
  await field.fill("12,5");
  await field.press("Enter");
  await expect.poll(async () => (await places()).some(([, y]) => y === 12.5)).toBe(true);
  await settled(page);
  await scene.focus();
  await scene.press("Shift+F10");
  await menu.getByRole("menuitem", { name: "Remove" }).waitFor();
  await page.keyboard.press("Escape");
  // Both are selected, and the last ones stay.
  await scene.press("Delete");
  expect(await copies()).toBe(2);
  await page.getByRole("radio", { name: "Look" }).click();
  await page.mouse.click(box.x + 4, box.y + box.height - 4, { button: "right" });
  await menu.getByRole("menuitem", { name: "Duplicate" }).click();
  await expect.poll(copies).toBe(4);
});

test("the slider cuts the model at the layer, if it is told to", async () => {
  const page = await start("?backend=cpu&rays=512&wall=1.5", { viewport: { width: 1280, height: 800 } });
  await drop(page, ball);
  await state(page, "done");
  const box = (await page.locator("cusp-view canvas").boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  /** Mean brightness of the picture where the upper half of the ball is. */
  const upper = async (): Promise<number> => {
    const clip = { x: box.x + 0.33 * box.width, y: box.y + 0.32 * box.height, width: 0.06 * box.width, height: 0.06 * box.height };
    const png = (await page.screenshot({ clip })).toString("base64");
    return page.evaluate(async (png) => {
      const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0))]));
      const context = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
      context?.drawImage(picture, 0, 0);
      const { data } = context?.getImageData(0, 0, picture.width, picture.height) ?? { data: [] };
      return [...data].reduce((sum, part) => sum + part, 0) / data.length;
    }, png);
  };
  await page.waitForTimeout(500);
  const whole = await upper();
  await page.locator("cusp-model summary").click();
  await page.getByRole("switch", { name: "Cut at the layer" }).click();
  await page.keyboard.press("Escape");
  expect(await page.locator("cusp-view").evaluate((view: CuspView) => view.cuts)).toBe(true);
  await expect.poll(async () => (await upper()) - whole).toBeGreaterThan(20);
});
