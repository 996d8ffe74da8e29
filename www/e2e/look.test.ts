/** The profile chart and the masks, by mouse, keyboard and touch. */
import type { BrowserContextOptions, Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { PlotPlace } from "../src/element/panels/profile-chart.js";
import { drop, layers, maskOf, openPanel, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();
const ELEMENT = "cusp-workbench";
const BALL_MM = 20;

async function opened(query = "", options: BrowserContextOptions = {}): Promise<Page> {
  const page = await start(`?backend=cpu&${query}`, options);
  await drop(page, { name: "ball.stl", bytes: sphere(BALL_MM / 2, 96).bytes });
  await state(page, "done");
  return page;
}

const plot = (page: Page): Locator => page.locator("cusp-chart .plot");

/** Waits for the chart, and returns a function for the heights it last reported. */
async function heights(page: Page): Promise<() => Promise<[low: number, high: number]>> {
  await page.locator("cusp-chart .marker").waitFor({ state: "attached" });
  const chart = page.locator("cusp-chart");
  await chart.evaluate((it) => {
    it.addEventListener("cusp-plot", (event) => {
      it.dataset["heights"] = JSON.stringify((event as CustomEvent<PlotPlace>).detail.heights_mm);
    });
  });
  return () => chart.evaluate((it, whole) => JSON.parse(it.dataset["heights"] ?? `[0,${whole}]`) as [number, number], BALL_MM);
}

test("the chart is read by pointer, a click looks at a layer, a pinch zooms; keys do the same", async () => {
  const page = await opened("rays=512&metric=volume");
  const over = page.locator("cusp-chart .u-over");
  const said = page.locator("cusp-chart .foot");
  await over.hover();
  // The middle of a ball of 10 mm radius.
  await expect.poll(() => said.innerText()).toMatch(/mm at (9\.\d\d|10\.[01]\d)\d\smm: the outline hardly changes/);
  const area = await over.boundingBox();
  if (area === null) throw new Error("there is no chart");
  await over.hover({ position: { x: area.width / 2, y: 0.05 * area.height } });
  await expect.poll(() => said.innerText()).toContain("the outline changes quickly");
  await over.click({ position: { x: area.width / 2, y: area.height / 4 } });
  const inView = page.getByRole("slider", { name: "Layer in the view" });
  expect(Number(/at (\d+\.\d+)/.exec((await inView.getAttribute("aria-valuetext")) ?? "")?.[1])).toBeCloseTo(15, 0);

  const shown = await heights(page);
  await over.hover();
  await page.mouse.wheel(0, -100);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -Math.log(2) * 100);
  await page.keyboard.up("Control");
  await expect.poll(shown).toEqual([expect.closeTo(BALL_MM / 4, 0), expect.closeTo((3 * BALL_MM) / 4, 0)]);
  await page.mouse.move(0, 0);
  await expect.poll(() => said.innerText()).toContain("Click to see a layer.");
  await page.getByRole("button", { name: "Whole model" }).click();

  const chart = page.getByRole("slider", { name: "Profile and plan" });
  const now = async (): Promise<number> => Number(await chart.getAttribute("aria-valuenow"));
  const count = Number(await chart.getAttribute("aria-valuemax"));
  const keys = async (...names: string[]): Promise<void> => {
    for (const name of names) await chart.press(name);
  };
  await keys("Home");
  await expect.poll(now).toBe(1);
  expect(await chart.getAttribute("aria-valuetext")).toMatch(/^Layer 1 of \d+, at 0\.000\smm, 0\.\d{3}\smm thick$/);
  await keys("ArrowDown", "ArrowUp", "ArrowRight", "PageUp");
  await expect.poll(now).toBe(13);
  await keys("PageDown", "ArrowLeft", "End", "ArrowUp");
  await expect.poll(now).toBe(count);

  const whole = page.getByRole("button", { name: "Whole model" });
  await expect.poll(() => whole.count()).toBe(0);
  await keys("+", "=");
  await expect.poll(shown).toEqual([expect.closeTo(BALL_MM - BALL_MM / 1.5 ** 2, 1), expect.closeTo(BALL_MM, 1)]);
  await whole.waitFor();
  // The visible range follows the layer.
  await keys("Home");
  await expect.poll(shown).toEqual([expect.closeTo(0, 1), expect.closeTo(BALL_MM / 1.5 ** 2, 1)]);
  await keys("-");
  await expect.poll(shown).toEqual([expect.closeTo(0, 1), expect.closeTo(BALL_MM / 1.5, 1)]);
  await keys("0");
  await expect.poll(shown).toEqual([0, BALL_MM]);
  await expect.poll(() => whole.count()).toBe(0);
  // The zoom is limited: some layers stay visible.
  await keys(...Array.from({ length: 20 }, () => "+"));
  await expect.poll(async () => -(await shown()).reduce((low, high) => low - high)).toBeCloseTo(0.6, 6);
  await whole.click();
  await expect.poll(shown).toEqual([0, BALL_MM]);
  expect(await page.evaluate(() => document.activeElement?.shadowRoot?.activeElement?.localName)).toBe("cusp-chart");
});

test("two fingers zoom and move the chart, one scrolls what it stands in, a tap looks at a layer; they zoom and drag a mask likewise", async () => {
  const page = await opened("", { hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  await openPanel(page, "Profile");
  const shown = await heights(page);
  const box = await page.locator("cusp-chart .u-over").boundingBox();
  if (box === null) throw new Error("there is no chart");
  const session = await page.context().newCDPSession(page);
  /** Positions are fractions of the plot's height; the fingers lie one above the other. */
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", ...parts: number[]): Promise<unknown> =>
    session.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: parts.map((part, id) => ({ id, x: box.x + box.width * (0.5 + 0.02 * id), y: box.y + box.height * (1 - part) })),
    });
  /** A gesture in small steps, as fingers make it. */
  const drag = async (from: number[], to: number[]): Promise<void> => {
    await touch("touchStart", ...from);
    for (let step = 1; step <= 10; step++) await touch("touchMove", ...from.map((part, i) => part + ((to[i] ?? 0) - part) * (step / 10)));
    await touch("touchEnd");
  };
  const near = (low: number, high: number): unknown[] => [expect.closeTo(low, 0), expect.closeTo(high, 0)];
  await drag([0.4, 0.6], [0.1, 0.9]);
  const [low, high] = await shown();
  expect(high - low).toBeCloseTo(BALL_MM / 4, 0);
  expect((low + high) / 2).toBeCloseTo(BALL_MM / 2, 0);
  await drag([0.4, 0.6], [0.6, 0.8]);
  await expect.poll(shown).toEqual(near(low - 0.2 * (high - low), high - 0.2 * (high - low)));
  await page.getByRole("button", { name: "Whole model" }).tap();
  await expect.poll(shown).toEqual([0, BALL_MM]);

  const said = page.locator("cusp-chart .foot");
  expect(await said.innerText()).toContain("Tap to see a layer. Pinch to zoom.");
  Object.assign(box, await page.locator("cusp-chart .u-over").boundingBox());
  await page.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 4);
  const text = (): Promise<string | null> => plot(page).getAttribute("aria-valuetext");
  await expect.poll(async () => Number(/at (\d+\.\d+)/.exec((await text()) ?? "")?.[1])).toBeCloseTo(15, 0);
  await expect.poll(() => said.innerText()).toMatch(/at 1[45]\.\d+\smm: the surface slopes$/);

  // In a scrolling box, like a page.
  await page.evaluate((element) => {
    const chart = document.querySelector(element)?.shadowRoot?.querySelector("cusp-chart");
    const section = chart?.parentElement;
    if (!chart || !section) throw new Error("there is no chart");
    chart.style.height = "auto";
    Object.assign(section.style, { height: "300px", flex: "none", overflow: "auto" });
    section.id = "scrolling";
  }, ELEMENT);
  const scrolled = (): Promise<number> => page.locator("#scrolling").evaluate((it) => it.scrollTop);
  const unmoved = await shown();
  Object.assign(box, await page.locator("cusp-chart .u-over").boundingBox());
  await drag([0.9, 0.95], [0.8, 0.98]);
  expect(await scrolled()).toBe(0);
  await expect.poll(shown).not.toEqual(unmoved);
  const zoomed = await shown();
  await drag([0.7], [0.95]);
  await expect.poll(scrolled).toBeGreaterThan(20);
  expect(await shown()).toEqual(zoomed);

  // Fingers zoom and drag a mask likewise, and not the page.
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  const well = await page.locator("cusp-mask .well").boundingBox();
  if (well === null) throw new Error("there is no picture");
  // At the left edge of the ball, so that movement is visible.
  const [x, y] = [well.x + (well.width - well.height) / 2 + 10, well.y + well.height / 2];
  const point = async (type: "touchStart" | "touchMove" | "touchEnd", ...fingers: (readonly [number, number])[]): Promise<void> => {
    await session.send("Input.dispatchTouchEvent", { type, touchPoints: fingers.map(([x, y], id) => ({ x, y, id })) });
  };
  const zoom = page.locator("cusp-mask .zoom");
  expect(await zoom.count()).toBe(0);
  await point("touchStart", [x, y - 20], [x, y + 20]);
  for (const reach of [30, 45, 60]) await point("touchMove", [x, y - reach], [x, y + reach]);
  await point("touchEnd");
  await expect.poll(() => zoom.innerText()).toBe("3 ×");
  expect(await page.evaluate(() => visualViewport?.scale)).toBe(1);
  expect(await page.locator("cusp-mask .hint .taps").isVisible()).toBe(true);
  expect(await page.locator("cusp-mask .hint .hovers").isVisible()).toBe(false);

  const picture = (): Promise<string> => page.locator("cusp-mask canvas").evaluate((it) => (it as HTMLCanvasElement).toDataURL());
  const before = await picture();
  await point("touchStart", [x, y]);
  for (const by of [20, 40, 60]) await point("touchMove", [x + by, y]);
  await point("touchEnd");
  await expect.poll(picture).not.toBe(before);
  expect(await zoom.innerText()).toBe("3 ×");
});

test("masks are played from below, zoomed to their pixels and moved by keyboard", async () => {
  const page = await opened("planner=uniform&uniform=0.15");
  const count = await layers(page);
  await openPanel(page, "Mask");
  const slider = page.getByRole("slider", { name: "Layer", exact: true });
  await slider.fill(String(count - 4));
  await maskOf(page, count - 5);
  await page.getByRole("button", { name: "Play" }).click();
  await maskOf(page, count - 1);
  await expect.poll(() => page.getByRole("button", { name: "Play" }).count()).toBe(1);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => {
    const root = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-mask")?.shadowRoot;
    return Number(root?.querySelector("canvas")?.dataset["layer"]) > 2;
  });
  await page.getByRole("button", { name: "Pause" }).click();

  await slider.fill(String(Math.round(count / 2)));
  await maskOf(page, Math.round(count / 2) - 1);
  const canvas = page.locator("cusp-mask canvas");
  /** Numbers of white and of grey pixels in the middle row. */
  const row = (): Promise<{ lit: number; grey: number }> =>
    canvas.evaluate((it) => {
      const canvas = it as HTMLCanvasElement;
      const { data } = canvas.getContext("2d")?.getImageData(0, canvas.height >> 1, canvas.width, 1) ?? { data: [] };
      const values = Array.from(data).filter((_, i) => i % 4 === 0);
      return { lit: values.filter((v) => v === 255).length, grey: values.filter((v) => v > 0 && v < 255).length };
    });
  await expect.poll(async () => (await row()).lit).toBeGreaterThan(0);
  for (let i = 0; i < 4; i++) await page.getByRole("button", { name: "Zoom in" }).click();
  expect(await page.locator("cusp-mask .zoom").innerText()).toContain("16 ×");
  const { lit } = await row();
  // A quarter from the left, the rim of the ball is at 1/2 - √3/4 from the top; an arrow key moves by an eighth of the view.
  await canvas.focus();
  for (let i = 0; i < 0.25 * 16 * 8; i++) await page.keyboard.press("ArrowLeft");
  for (let i = 0; i < (Math.sqrt(3) / 4) * 16 * 8; i++) await page.keyboard.press("ArrowUp");
  await expect.poll(async () => (await row()).lit).toBeLessThan(lit);
  expect((await row()).lit).toBeGreaterThan(0);
  expect((await row()).grey).toBe(0);
  await page.keyboard.press("-");
  expect(await page.locator("cusp-mask .zoom").innerText()).toContain("8 ×");
});

test("a mask of a printer shows the model first; it says its area and exposure, colours changes, and measures between two points", async () => {
  const page = await start("?printer=mars-4-ultra", { viewport: { width: 1280, height: 800 } });
  await drop(page, { name: "ball.stl", bytes: sphere(10, 48).bytes });
  await state(page, "done");
  await openPanel(page, "Mask");
  const panel = page.locator("cusp-mask");
  const middle = Math.floor((await layers(page)) / 2);
  await maskOf(page, middle);
  expect(await panel.locator(".zoom").count()).toBe(1);
  const fact = async (name: string): Promise<number> => Number.parseFloat(await panel.locator("dl div").filter({ hasText: name }).locator("dd").innerText());
  expect(await fact("Lit area")).toBeCloseTo(Math.PI * 100, -1);
  expect(await fact("Exposure")).toBeGreaterThan(0);

  // Below the equator each layer adds a ring.
  const orange = (): Promise<number> =>
    panel.locator("canvas").evaluate((it) => {
      const canvas = it as HTMLCanvasElement;
      const { data } = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height) ?? { data: [] };
      return Array.from(data).filter((value, i) => i % 4 === 0 && value === 255 && data[i + 2] === 26).length;
    });
  const slider = page.getByRole("slider", { name: "Layer", exact: true });
  await slider.fill(String(Math.round(0.1 * middle)));
  expect(await orange()).toBe(0);
  await panel.getByRole("button", { name: "Changes from the layer below" }).click();
  await expect.poll(orange).toBeGreaterThan(20);
  await panel.getByText("New in this layer").waitFor();
  await panel.getByRole("button", { name: "Changes from the layer below" }).click();
  await expect.poll(orange).toBe(0);

  await panel.getByRole("button", { name: "Measure between two points" }).click();
  const box = (await panel.locator("canvas").boundingBox()) ?? { x: 0, y: 0, width: 0, height: 0 };
  await page.mouse.click(box.x + 0.25 * box.width, box.y + 0.6 * box.height);
  await page.mouse.click(box.x + 0.75 * box.width, box.y + 0.6 * box.height);
  const length = Number.parseFloat((await panel.locator("canvas").getAttribute("data-length")) ?? "");
  // The ball of 20 mm and some room fill the narrower side.
  const across = (20 * 1.15 * box.width) / Math.min(box.width, box.height);
  expect(Math.abs(length - across / 2)).toBeLessThan(0.03 * across);
});
