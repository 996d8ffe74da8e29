/** The chart of the profile by mouse, keyboard and fingers, in boxes of many sizes, and in forced colours. */
import type { BrowserContextOptions, Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { PlotPlace } from "../src/element/panels/profile-chart.js";
import { LANGUAGES } from "../src/texts/index.js";
import { broken } from "./axe.js";
import { drop, openPanel, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();
const ELEMENT = "cusp-workbench";
const BALL_MM = 20;

async function opened(query = "", options: BrowserContextOptions = {}, isOwn = false): Promise<Page> {
  const page = await start(`?backend=cpu&${query}`, options, isOwn);
  await drop(page, { name: "ball.stl", bytes: sphere(BALL_MM / 2, 96).bytes });
  await state(page, "done");
  return page;
}

const plot = (page: Page): Locator => page.locator("cusp-chart .plot");

/** Waits until the chart has drawn itself, and from then on keeps what it says of its heights. */
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

/** Puts another chart of the same plan into a box over the page. Without a height, the box is as high as the chart. */
async function boxed(page: Page, width_px: number, height_px: number | null): Promise<Locator> {
  await page.evaluate(
    ([element, width_px, height_px]) => {
      const root = document.querySelector(element)?.shadowRoot;
      const chart = root?.querySelector("cusp-chart");
      if (!root || !chart) throw new Error("there is no chart");
      root.querySelector("#box")?.remove();
      const box = document.createElement("div");
      box.id = "box";
      Object.assign(box.style, { position: "fixed", inset: "0 auto auto 0", zIndex: "9", background: "Canvas", width: `${width_px}px` });
      box.style.setProperty("--cusp-title-position", "static");
      box.style.setProperty("--cusp-title-clip", "none");
      const other = document.createElement("cusp-chart");
      const { data, layer, language } = chart;
      Object.assign(other, { data, layer, language });
      if (height_px !== null) {
        box.style.height = `${height_px}px`;
        other.style.height = "100%";
      }
      box.append(other);
      root.append(box);
    },
    [ELEMENT, width_px, height_px] as const,
  );
  const box = page.locator("#box");
  await box.locator(".marker").waitFor({ state: "attached" });
  return box;
}

test("keys move the layer and zoom around it, and the chart says which layer it is", async () => {
  const page = await opened();
  const shown = await heights(page);
  const chart = page.getByRole("slider", { name: "Profile and plan" });
  const now = async (): Promise<number> => Number(await chart.getAttribute("aria-valuenow"));
  const count = Number(await chart.getAttribute("aria-valuemax"));
  const keys = async (...names: string[]): Promise<void> => {
    for (const name of names) await chart.press(name);
  };
  await keys("Home");
  await expect.poll(now).toBe(1);
  expect(await chart.getAttribute("aria-valuetext")).toMatch(/^Layer 1 of \d+, at 0\.000\smm, 0\.0\d\d\smm thick$/);
  await keys("ArrowDown", "ArrowUp", "ArrowRight", "PageUp");
  await expect.poll(now).toBe(13);
  await keys("PageDown", "ArrowLeft", "End", "ArrowUp");
  await expect.poll(now).toBe(count);

  const whole = page.getByRole("button", { name: "Whole model" });
  expect(await whole.count()).toBe(0);
  await keys("+", "=");
  await expect.poll(shown).toEqual([expect.closeTo(BALL_MM - BALL_MM / 1.5 ** 2, 1), expect.closeTo(BALL_MM, 1)]);
  await whole.waitFor();
  // What is on show follows the layer.
  await keys("Home");
  await expect.poll(shown).toEqual([expect.closeTo(0, 1), expect.closeTo(BALL_MM / 1.5 ** 2, 1)]);
  await keys("-");
  await expect.poll(shown).toEqual([expect.closeTo(0, 1), expect.closeTo(BALL_MM / 1.5, 1)]);
  await keys("0");
  await expect.poll(shown).toEqual([0, BALL_MM]);
  await expect.poll(() => whole.count()).toBe(0);
  // However far: some layers stay on show.
  await keys(...Array.from({ length: 20 }, () => "+"));
  await expect.poll(async () => -(await shown()).reduce((low, high) => low - high)).toBeCloseTo(0.6, 6);
  await whole.click();
  await expect.poll(shown).toEqual([0, BALL_MM]);
  expect(await page.evaluate(() => document.activeElement?.shadowRoot?.activeElement?.localName)).toBe("cusp-chart");
  expect(await broken(page)).toEqual([]);
});

test("a pinch on a trackpad zooms at the pointer; the wheel alone scrolls", async () => {
  const page = await opened();
  const shown = await heights(page);
  await page.locator("cusp-chart .u-over").hover();
  await page.mouse.wheel(0, -100);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -Math.log(2) * 100);
  await page.keyboard.up("Control");
  await expect.poll(shown).toEqual([expect.closeTo(BALL_MM / 4, 0), expect.closeTo((3 * BALL_MM) / 4, 0)]);
});

test("two fingers zoom and move the chart, one scrolls what it stands in, a tap looks at a layer", async () => {
  const page = await opened("", { hasTouch: true, isMobile: true, viewport: { width: 390, height: 844 } });
  await openPanel(page, "Profile");
  const shown = await heights(page);
  const box = await page.locator("cusp-chart .u-over").boundingBox();
  if (box === null) throw new Error("there is no chart");
  const session = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", ...parts: number[]): Promise<unknown> =>
    session.send("Input.dispatchTouchEvent", {
      type,
      // Heights as parts of the plot; the fingers lie one above the other.
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
  await expect.poll(() => said.innerText()).toMatch(/^At 1[45]\.\d+\smm: /);

  // In a box that scrolls, as a page does.
  await page.evaluate((element) => {
    const chart = document.querySelector(element)?.shadowRoot?.querySelector("cusp-chart");
    const section = chart?.parentElement;
    if (!chart || !section) throw new Error("there is no chart");
    chart.style.height = "auto";
    Object.assign(section.style, { height: "300px", flex: "none", overflow: "auto" });
    section.id = "scrolling";
  }, ELEMENT);
  const scrolled = (): Promise<number> => page.locator("#scrolling").evaluate((it) => it.scrollTop);
  const before = await shown();
  Object.assign(box, await page.locator("cusp-chart .u-over").boundingBox());
  await drag([0.9, 0.95], [0.8, 0.98]);
  expect(await scrolled()).toBe(0);
  await expect.poll(shown).not.toEqual(before);
  const zoomed = await shown();
  await drag([0.7], [0.95]);
  await expect.poll(scrolled).toBeGreaterThan(20);
  expect(await shown()).toEqual(zoomed);
});

test.each(LANGUAGES)("nothing is cut or overlaps in a narrow box, nor moves under the pointer: %s", async (locale) => {
  for (const metric of ["cusp", "area", "volume"]) {
    const page = await opened(`metric=${metric}&locale=${locale}`);
    for (const [width, height] of [[170, 400], [140, 900], [170, null]] as const) {
      const box = await boxed(page, width, height);
      const rects = (): Promise<{ name: string; top: number; bottom: number; right: number }[]> =>
        box.locator("cusp-chart").evaluate(({ shadowRoot }) =>
          [...(shadowRoot?.querySelectorAll("h3, .top, .plot, .key li, .limits, .foot") ?? [])].map((it) => {
            const { top, bottom, right } = it.getBoundingClientRect();
            return { name: it.className || it.localName, top, bottom, right: Math.max(right, it.getBoundingClientRect().left + it.scrollWidth) };
          }),
        );
      const before = await rects();
      const bottom = (await box.boundingBox())?.height ?? 0;
      for (const [i, { name, right, top }] of before.entries()) {
        expect(right, name).toBeLessThanOrEqual(width + 0.5);
        if (i > 0 && name !== "limits figures") expect(top, name).toBeGreaterThanOrEqual((before[i - 1]?.bottom ?? 0) - 0.5);
      }
      expect(before.at(-1)?.bottom).toBeLessThanOrEqual(bottom + 0.5);
      if (height !== null) expect(before.at(-1)?.bottom).toBeGreaterThan(height - 1);
      else expect(await box.locator(".plot").evaluate((it) => it.clientHeight)).toBe(30 * 16);
      const hint = await box.locator(".foot").innerText();
      await box.locator(".u-over").hover();
      await expect.poll(() => box.locator(".foot").innerText()).not.toBe(hint);
      expect(await rects()).toEqual(before);
      await page.mouse.move(600, 5);
    }
    const wide = await boxed(page, 410, null);
    expect(await wide.locator(".plot").evaluate((it) => it.clientHeight)).toBe(30 * 16);
  }
});

test("forced colours reach the canvas, the marker and the key", async () => {
  const page = await opened("", {}, true);
  /** Pixels of the canvas in a system colour. */
  const pixels = (system: string): Promise<number> =>
    page.locator("cusp-chart canvas").evaluate((it, system) => {
      const canvas = it as HTMLCanvasElement;
      const probe = document.createElement("canvas").getContext("2d");
      const pen = canvas.getContext("2d");
      if (probe === null || pen === null) throw new Error("there is no canvas");
      const span = document.createElement("span");
      span.style.color = system;
      document.body.append(span);
      probe.fillStyle = getComputedStyle(span).color;
      span.remove();
      probe.fillRect(0, 0, 1, 1);
      const [r, g, b] = probe.getImageData(0, 0, 1, 1).data;
      const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
      let found = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i] === r && data[i + 1] === g && data[i + 2] === b && data[i + 3] === 255) found++;
      return found;
    }, system);
  await page.locator("cusp-chart canvas").waitFor();
  expect(await pixels("CanvasText")).toBe(0);
  await page.emulateMedia({ forcedColors: "active", colorScheme: "dark" });
  await expect.poll(() => pixels("CanvasText")).toBeGreaterThan(100);
  const styles = await page.locator("cusp-chart").evaluate(({ shadowRoot }) => {
    const style = (selector: string): CSSStyleDeclaration => {
      const found = shadowRoot?.querySelector(selector);
      if (!found) throw new Error(`there is no ${selector}`);
      return getComputedStyle(found);
    };
    return [style(".marker").borderTopColor, style(".line").borderTopColor, style(".scale").backgroundImage.slice(0, 15)];
  });
  const [marker, line, scale] = styles;
  expect(marker).not.toBe(line);
  expect(line).toBe("rgb(255, 255, 255)");
  expect(scale).toBe("linear-gradient");
});
