/** The panels of the element in a narrow column, in every language, in forced colours and under fingers. */
import type { Browser, BrowserContextOptions, Locator, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, test } from "vitest";
import type { CuspSlicer } from "../src/element/index.js";
import { broken } from "./axe.js";
import { launch, state } from "./browser.js";
import { servePacked } from "./packed.js";
import type { Served } from "./serve.js";
import { cup, sphere } from "./solids.js";

/** The inner width of a narrow column. */
const NARROW_PX = 260;

const html = `<!doctype html><html lang="en"><meta charset="utf-8" /><title>Panels</title>
<meta name="viewport" content="width=device-width" />
<script type="module" src="cusp-slicer/element.js"></script>
<body><main><h1>Shop</h1><h2>Panels</h2><cusp-slicer src="ball.stl" panels="orientation quality layers findings"></cusp-slicer></main></body></html>`;

let browser: Browser;
let served: Served;
const pages: Page[] = [];

beforeAll(async () => {
  served = await servePacked({ "index.html": html, "ball.stl": sphere(10, 96).bytes, "mug.stl": cup(10, 8, 1.5) });
  browser = await launch();
}, 240_000);

afterAll(async () => {
  await browser.close();
  await served.close();
});

afterEach(async () => {
  await Promise.all(pages.splice(0).map((page) => page.context().close()));
});

async function start(options: BrowserContextOptions = {}): Promise<Page> {
  const page = await (await browser.newContext({ serviceWorkers: "block", reducedMotion: "reduce", ...options })).newPage();
  pages.push(page);
  await page.goto(served.address);
  await state(page, "done");
  await page.locator("cusp-quality svg").waitFor();
  await page.waitForSelector("cusp-mask canvas[data-layer]");
  return page;
}

async function searched(page: Page): Promise<void> {
  await page.locator("cusp-orientation .find").click();
  await page.locator("cusp-orientation .now").waitFor({ timeout: 60_000 });
}

/** Opens the card of findings, which has them checked. */
async function checked(page: Page): Promise<void> {
  await page.locator("cusp-slicer details.findings > summary").click();
  await page.waitForSelector("cusp-findings [data-verdict]");
}

/** Gives a panel a box of its own. */
async function fit(panel: Locator, width_px: number, height_px?: number): Promise<void> {
  await panel.evaluate(
    (it: HTMLElement, [width, height]) => {
      it.style.width = `${width}px`;
      if (height !== undefined) it.style.height = `${height}px`;
    },
    [width_px, height_px] as const,
  );
}

/** What does not fit a panel: texts that leave it, texts that lie on each other, and choices that are cut. */
function cramped(panel: Locator): Promise<string[]> {
  return panel.evaluate((host) => {
    const roots: ShadowRoot[] = [];
    const collect = (root: ShadowRoot | null): void => {
      if (root === null) return;
      roots.push(root);
      for (const it of root.querySelectorAll("*")) collect(it.shadowRoot);
    };
    collect(host.shadowRoot);
    const { left, right, top, bottom } = host.getBoundingClientRect();
    const texts: { said: string; box: DOMRect }[] = [];
    const wrong: string[] = [];
    for (const root of roots) {
      const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
      for (let node = walker.nextNode(); node !== null; node = walker.nextNode()) {
        const said = node.textContent?.trim() ?? "";
        const parent = node.parentElement;
        if (said === "" || parent === null || parent.closest(".visually-hidden, select, style, svg") !== null) continue;
        if (!parent.checkVisibility({ visibilityProperty: true }) || getComputedStyle(parent).clipPath !== "none") continue;
        const range = document.createRange();
        range.selectNodeContents(node);
        for (const box of range.getClientRects()) texts.push({ said, box });
      }
      for (const select of root.querySelectorAll("select")) {
        const pen = document.createElement("canvas").getContext("2d");
        const { font, paddingInlineStart, paddingInlineEnd } = getComputedStyle(select);
        if (pen === null) continue;
        pen.font = font;
        const room = select.clientWidth - parseFloat(paddingInlineStart) - parseFloat(paddingInlineEnd);
        for (const { text } of select.options) if (pen.measureText(text).width > room) wrong.push(`cut: ${text}`);
      }
    }
    for (const [i, { said, box }] of texts.entries()) {
      if (box.left < left - 1 || box.right > right + 1 || box.top < top - 1 || box.bottom > bottom + 1) wrong.push(`out: ${said}`);
      for (const other of texts.slice(i + 1)) {
        const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left);
        const down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
        if (across > 1 && down > 4) wrong.push(`on each other: ${said} | ${other.said}`);
      }
    }
    return wrong;
  });
}

test.each(["en-GB", "de-DE", "es-ES", "fr-FR", "zh-CN"])("a narrow column holds every panel's texts in %s", async (locale) => {
  const page = await start({ locale });
  await searched(page);
  await checked(page);
  for (const name of ["cusp-orientation", "cusp-quality", "cusp-mask", "cusp-findings"]) {
    const panel = page.locator(name);
    await fit(panel, NARROW_PX);
    expect(await cramped(panel), name).toEqual([]);
  }
  const mask = page.locator("cusp-mask");
  await fit(mask, NARROW_PX, 400);
  for (let i = 0; i < 6; i++) await mask.locator(".tools button").last().click();
  expect(await cramped(mask), "zoomed").toEqual([]);
});

test("the picture of a mask takes the height that is left, at least 160 px, and zooming moves nothing", async () => {
  const page = await start();
  const mask = page.locator("cusp-mask");
  const sizes = async (): Promise<{ well: number; over: number }> =>
    mask.evaluate((host) => {
      const bottom = (selector: string): number => host.shadowRoot?.querySelector(selector)?.getBoundingClientRect().bottom ?? 0;
      const well = host.shadowRoot?.querySelector(".well")?.getBoundingClientRect().height ?? 0;
      return { well, over: Math.round(bottom("dl") - host.getBoundingClientRect().bottom) };
    });
  await fit(mask, NARROW_PX, 500);
  const high = await sizes();
  await fit(mask, NARROW_PX, 400);
  const low = await sizes();
  expect(high.well - low.well).toBeCloseTo(100, 0);
  expect([high.over, low.over]).toEqual([0, 0]);
  await mask.locator(".tools button").last().click();
  expect(await sizes()).toEqual(low);
  await fit(mask, NARROW_PX, 100);
  expect((await sizes()).well).toBe(160);
  const small = await mask.locator("button").evaluateAll((all) =>
    all.map((it) => it.getBoundingClientRect()).filter(({ width, height }) => width < 36 || height < 36),
  );
  expect(small).toEqual([]);
});

test("two fingers zoom a mask, not the page, and one drags it; the hint is for fingers", async () => {
  const page = await start({ hasTouch: true, isMobile: true, viewport: { width: 390, height: 600 } });
  const well = page.locator("cusp-mask .well");
  await well.scrollIntoViewIfNeeded();
  const box = await well.boundingBox();
  if (box === null) throw new Error("there is no picture");
  // At the left edge of the ball, so that there is something to see when it moves.
  const [x, y] = [box.x + (box.width - box.height) / 2, box.y + box.height / 2];
  const session = await page.context().newCDPSession(page);
  const touch = async (type: "touchStart" | "touchMove" | "touchEnd", ...fingers: (readonly [number, number])[]): Promise<void> => {
    await session.send("Input.dispatchTouchEvent", { type, touchPoints: fingers.map(([x, y], id) => ({ x, y, id })) });
  };
  const zoom = page.locator("cusp-mask .zoom");
  expect(await zoom.count()).toBe(0);
  const before = await page.evaluate(() => scrollY);
  await touch("touchStart", [x, y - 20], [x, y + 20]);
  for (const reach of [30, 45, 60]) await touch("touchMove", [x, y - reach], [x, y + reach]);
  await touch("touchEnd");
  await expect.poll(() => zoom.innerText()).toBe("3 ×");
  expect(await page.evaluate(() => [scrollY, visualViewport?.scale])).toEqual([before, 1]);
  expect(await page.locator("cusp-mask .hint .taps").isVisible()).toBe(true);
  expect(await page.locator("cusp-mask .hint .hovers").isVisible()).toBe(false);

  const picture = (): Promise<string> => page.locator("cusp-mask canvas").evaluate((it) => (it as HTMLCanvasElement).toDataURL());
  const zoomed = await picture();
  await touch("touchStart", [x, y]);
  for (const by of [20, 40, 60]) await touch("touchMove", [x + by, y]);
  await touch("touchEnd");
  await expect.poll(picture).not.toBe(zoomed);
  expect(await zoom.innerText()).toBe("3 ×");
});

test.each(["light", "dark"] as const)("in forced colours, %s, what is chosen, scales and the curve are seen", async (colorScheme) => {
  const page = await start({ forcedColors: "active", colorScheme });
  await searched(page);
  await page.locator("cusp-orientation .pose").first().click();
  await page.locator("cusp-orientation .pose[aria-pressed=true]").waitFor();
  const style = (selector: string, property: string): Promise<string> =>
    page.locator(selector).first().evaluate((it, property) => getComputedStyle(it).getPropertyValue(property), property);
  expect(await style("cusp-orientation .pose[aria-pressed=true]", "outline-style")).toBe("solid");
  expect(await style("cusp-orientation .pose[aria-pressed=false]", "outline-style")).toBe("none");
  expect(await style("cusp-orientation .scale i", "background-image")).toContain("linear-gradient");
  expect(await style("cusp-mask .well", "background-color")).toBe("rgb(0, 0, 0)");
  const thickness = await style("cusp-mask .swatch", "background-color");
  const paper = await page.evaluate(() => {
    const probe = document.body.appendChild(document.createElement("span"));
    probe.style.backgroundColor = "Canvas";
    return getComputedStyle(probe).backgroundColor;
  });
  for (const selector of [".curve", ".dot", ".uniform:not(.inside)", ".own:not(.inside)", ".base"]) {
    expect(await style(`cusp-quality ${selector}`, "stroke"), selector).not.toBe(paper);
  }
  expect(thickness).not.toBe(paper);
});

test("the panels break no rule of accessibility in a narrow column", async () => {
  const page = await start({ viewport: { width: 300, height: 900 } });
  await searched(page);
  await checked(page);
  expect(await broken(page)).toEqual([]);
});

test("the element checks nothing before its card of findings is open, and then shows where they are", async () => {
  const page = await start();
  await page.locator("cusp-slicer").evaluate((element: CuspSlicer) => void (element.src = "mug.stl"));
  await state(page, "busy");
  await state(page, "done");
  const check = (): Promise<unknown> => page.locator("cusp-slicer").evaluate((element: CuspSlicer) => element.check);
  expect(await check()).toBeNull();
  await checked(page);
  expect(await check()).not.toBeNull();
  const finding = page.locator("cusp-findings button[aria-pressed]").first();
  await finding.click();
  expect(await finding.getAttribute("aria-pressed")).toBe("true");
  await page.waitForSelector("cusp-mask canvas[data-marked]");
});
