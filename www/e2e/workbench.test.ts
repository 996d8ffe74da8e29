/** The page as a workbench: all of a job on one screen, and on a phone the view first. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { broken } from "./axe.js";
import { download, drop, layers, openPanel, settled, SOFTWARE_GL, state } from "./browser.js";
import { beforeView, whole } from "./loaded.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages(SOFTWARE_GL);
const ball = { name: "ball.stl", bytes: sphere(10, 96).bytes };
const DESKTOP = { viewport: { width: 1280, height: 800 } };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** Pixels that the page is larger than its window. */
const overflow = (page: Page): Promise<[number, number]> =>
  page.evaluate(() => {
    const { scrollWidth, scrollHeight } = document.documentElement;
    return [scrollWidth - innerWidth, scrollHeight - innerHeight];
  });

/** Expects all of these in the window and not cut off by a panel that scrolls. */
async function inSight(page: Page, selectors: readonly string[]): Promise<void> {
  for (const selector of selectors) {
    const ratio = await page.locator(selector).first().evaluate(
      (element) =>
        new Promise<number>((resolve) => {
          new IntersectionObserver(([entry]) => resolve(entry?.intersectionRatio ?? 0)).observe(element);
        }),
    );
    expect(ratio, selector).toBeGreaterThan(0.99);
  }
}

test("at 1280 × 800 nothing scrolls, from the drop to the download", async () => {
  const page = await start("", DESKTOP);
  expect(await overflow(page)).toEqual([0, 0]);
  await inSight(page, ["[part=drop]", "#printer"]);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await page.waitForSelector(".u-over");
  await inSight(page, ["cusp-view", "cusp-layer-slider", ".u-over", "[data-layers]", ".download", "#printer", "#tolerance"]);
  await page.getByLabel("Tolerance", { exact: true }).fill("0.08");
  await settled(page);
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  await inSight(page, ["cusp-view", ".download", "cusp-mask canvas"]);
  await openPanel(page, "Turn");
  await inSight(page, ["cusp-view", ".download"]);
  expect((await download(page)).suggestedFilename()).toBe("ball-cusp.zip");
  expect(await overflow(page)).toEqual([0, 0]);
});

test("at 1280 × 800 all tools of a turned and hollow model are in one line, so that the view is beside the profile", async () => {
  const page = await start("?wall=1.5&rotation=0.5,0.5,0.5,0.5", DESKTOP);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector(".u-over");
  expect(await page.getByRole("radio", { name: "Drain holes" }).count()).toBe(1);
  await page.getByRole("switch", { name: "Beside the profile" }).waitFor();
  const tops = await page.locator("cusp-model .group, cusp-model .upright").evaluateAll((them) => them.map((it) => Math.round(it.getBoundingClientRect().top)));
  expect(tops).toHaveLength(3);
  expect(Math.max(...tops) - Math.min(...tops)).toBeLessThan(4);
});

test("the view grows with the window", async () => {
  const page = await start("", DESKTOP, true);
  await drop(page, ball);
  await state(page, "done");
  const area = async (): Promise<number> => {
    const box = await page.locator("cusp-view").boundingBox();
    return (box?.width ?? 0) * (box?.height ?? 0);
  };
  const before = await area();
  // The largest thing on the screen.
  const others = await page.locator(".side > *").evaluateAll((them) => them.map((it) => it.clientWidth * it.clientHeight));
  expect(Math.max(...others)).toBeLessThan(before);
  await page.setViewportSize({ width: 1920, height: 1080 });
  await expect.poll(area).toBeGreaterThan(2 * before);
});

test("nothing on the page moves while a plan is made, first or again", async () => {
  const page = await start("", DESKTOP);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await page.waitForSelector(".u-over");
  await page.evaluate(() => {
    const shifts: string[] = [];
    Object.assign(window, { shifts });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as (PerformanceEntry & { sources: { previousRect: DOMRect; currentRect: DOMRect }[] })[]) {
        const at = ({ x, y, width, height }: DOMRect): string => `${x}, ${y}, ${width} × ${height}`;
        shifts.push(...entry.sources.map(({ previousRect, currentRect }) => `${at(previousRect)} → ${at(currentRect)}`));
      }
    }).observe({ type: "layout-shift" });
  });
  for (const typed of ["0.08", "0.06"]) {
    await page.getByLabel("Tolerance", { exact: true }).fill(typed);
    await settled(page);
  }
  await drop(page, { name: "other.stl", bytes: sphere(8, 96).bytes });
  await expect.poll(() => page.locator(".model-name").innerText()).toBe("other.stl");
  await state(page, "done");
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  expect(await page.evaluate(() => (window as unknown as { shifts: string[] }).shifts)).toEqual([]);
});

test("a first drop that no plan fits shows the model, why, and what would help, in the middle", async () => {
  const page = await start("?tolerance=0.01", DESKTOP);
  await drop(page, ball);
  await state(page, "error");
  await page.waitForSelector("cusp-view");
  await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain("20");
  const alert = page.locator(".stage").getByRole("alert");
  expect(await alert.innerText()).toContain("No plan keeps the tolerance all the way up");
  // Another plan with the same settings would fail in the same way.
  expect(await page.getByRole("button", { name: "Plan the layers" }).count()).toBe(0);
  await alert.getByRole("button", { name: "Close" }).click();
  expect(await page.getByRole("button", { name: "Plan the layers" }).count()).toBe(0);
  await page.getByLabel("Tolerance", { exact: true }).fill("0.011");
  await state(page, "error");
  await page.locator(".stage").getByRole("alert").getByRole("button", { name: /^Tolerance/ }).click();
  await settled(page);
  expect(await layers(page)).toBeGreaterThan(134);
});

test("the slider beside the view stands at the height of its layer, also where the chart is zoomed", async () => {
  const page = await start("", DESKTOP);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector(".u-over");
  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await slider.focus();
  const said = (): Promise<string | null> => slider.getAttribute("aria-valuetext");
  const count = await layers(page);
  for (const [key, layer] of [["Home", 1], ["ArrowUp", 2], ["PageUp", 12], ["ArrowDown", 11], ["End", count]] as const) {
    await page.keyboard.press(key);
    await expect.poll(said).toMatch(new RegExp(`^Layer ${layer} of ${count}`));
  }
  /** Where the slider's thumb and the chart's marker are, from the window's top. */
  const tops = (): Promise<[number, number]> =>
    slider.evaluate((element) => {
      const input = element as HTMLInputElement;
      const { top, height } = input.getBoundingClientRect();
      const thumb = 16;
      const [min, max, value] = [input.min, input.max, input.value].map(Number) as [number, number, number];
      const chart = (element.getRootNode() as ShadowRoot).host.parentElement?.querySelector("cusp-chart");
      const marker = chart?.shadowRoot?.querySelector(".marker")?.getBoundingClientRect().top ?? Number.NaN;
      return [top + thumb / 2 + (height - thumb) * (1 - (value - min) / (max - min)), marker + 1];
    });
  const plot = page.locator(".u-over");
  const box = await plot.boundingBox();
  if (box === null) throw new Error("there is no chart");
  for (const part of [0.2, 0.5, 0.8]) {
    await plot.click({ position: { x: box.width / 2, y: part * box.height } });
    await expect.poll(async () => Math.abs((await tops())[0] - (await tops())[1])).toBeLessThan(2);
  }
  const before = await said();
  await page.mouse.move(box.x + 20, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 20, box.y + 0.9 * box.height, { steps: 5 });
  await page.mouse.up();
  await expect.poll(() => slider.getAttribute("max").then(Number)).toBeLessThan(15);
  expect(await said()).toBe(before);
  await expect.poll(async () => Math.abs((await tops())[0] - (await tops())[1])).toBeLessThan(2);
});

test("tabs are chosen with the arrow keys", async () => {
  const page = await start("", DESKTOP);
  await drop(page, ball);
  await state(page, "done");
  await page.getByRole("tab", { name: "Quality" }).focus();
  await page.keyboard.press("ArrowRight");
  await page.locator("cusp-mask").waitFor();
  expect(await page.getByRole("tab", { name: "Mask" }).getAttribute("aria-selected")).toBe("true");
  await page.keyboard.press("ArrowRight");
  await page.locator("cusp-quality").waitFor();
  await page.keyboard.press("End");
  await page.locator("cusp-mask").waitFor();
});

test("on a phone the view comes first, the bar stays, and panels are sheets", async () => {
  const page = await start("", PHONE);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await inSight(page, ["cusp-view", "cusp-layer-slider", ".bar [data-layers]", ".bar .download"]);
  const whole = (await page.locator("cusp-view").boundingBox())?.height ?? 0;
  expect(whole).toBeGreaterThan(844 / 2);
  for (const name of ["Turn", "Check", "Hollow", "Support", "Slice", "Profile", "Quality", "Mask"]) {
    await page.locator("nav").getByRole("button", { name }).tap();
    await page.locator(".sheet").getByRole("heading", { name, level: 2 }).waitFor();
    await inSight(page, ["cusp-view", ".bar [data-layers]", ".bar .download"]);
    expect(await overflow(page)).toEqual([0, 0]);
    expect(await broken(page)).toEqual([]);
  }
  await page.getByRole("button", { name: "Show the result" }).tap();
  await page.locator(".sheet").getByText("Watertight").waitFor();
  await page.getByRole("button", { name: "Close" }).tap();
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  await page.locator("nav").getByRole("button", { name: "Slice" }).tap();
  await page.getByLabel("Tolerance", { exact: true }).fill("0.08");
  await settled(page);
  await page.keyboard.press("Escape");
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  await expect.poll(async () => (await page.locator("cusp-view").boundingBox())?.height).toBe(whole);
});

test("on the smallest phone an open sheet leaves the view its room, and has some itself", async () => {
  const page = await start("", { ...PHONE, viewport: { width: 320, height: 640 } });
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  for (const name of ["Support", "Profile"]) {
    await page.locator("nav").getByRole("button", { name }).tap();
    await page.locator(".sheet").getByRole("heading", { name, level: 2 }).waitFor();
    await inSight(page, ["cusp-view", ".sheet", ".bar .download"]);
    const height = async (selector: string): Promise<number> => (await page.locator(selector).boundingBox())?.height ?? 0;
    expect(await height("cusp-view")).toBeGreaterThan(165);
    expect(await height(".sheet .panel")).toBeGreaterThan(110);
    expect(await overflow(page)).toEqual([0, 0]);
  }
});

test("a sheet that closes gives the focus back to the button that opens it", async () => {
  const page = await start("", PHONE);
  await drop(page, ball);
  await state(page, "done");
  const focused = (): Promise<string | undefined> =>
    page.locator("cusp-workbench").evaluate(({ shadowRoot }) => shadowRoot?.activeElement?.textContent?.trim().replace(/\s+/g, " "));
  const press = (name: string): Promise<void> => page.locator(".path, .bar").getByRole("button", { name }).press("Enter");
  const open = async (name: string, title = name): Promise<void> => {
    await press(name);
    await page.locator(".sheet").getByRole("heading", { name: title, level: 2 }).waitFor();
  };
  const close = page.locator(".sheet").getByRole("button", { name: "Close" });
  for (const [name, title] of [["Slice", "Slice"], ["Profile", "Profile"], ["Show the result", "Result"]] as const) {
    for (const way of [() => close.press("Escape"), () => close.press("Enter"), () => press(name)]) {
      await open(name, title);
      await way();
      await expect.poll(() => page.locator(".sheet").count()).toBe(0);
      expect(await focused()).toContain(name);
    }
  }
  // From step to step: the button of the last one.
  await open("Turn");
  await page.getByRole("button", { name: "Next: Check" }).press("Enter");
  await page.locator(".sheet").getByRole("heading", { name: "Check", level: 2 }).waitFor();
  await page.keyboard.press("Escape");
  await expect.poll(focused).toContain("Check");
  // What is not in the sheet keeps the focus.
  await open("Slice");
  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await slider.focus();
  await page.keyboard.press("Escape");
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  expect(await page.locator("cusp-workbench").evaluate(({ shadowRoot }) => shadowRoot?.activeElement?.localName)).toBe("cusp-layer-slider");
});

test("what the page loads before its 3-D view, beside the wasm, is at most 124 KB", async () => {
  const page = await start("", { locale: "de-DE", ...DESKTOP }, true);
  const sizes = await beforeView(page);
  await page.reload();
  await state(page, "empty");
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector(".u-over");
  expect(sizes.size).toBeGreaterThan(4);
  expect(whole(sizes), [...sizes].map(([name, size]) => `${name} ${size}`).join("\n")).toBeLessThanOrEqual(124_000);
});
