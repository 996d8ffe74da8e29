/** Layout and colours of the page: wide and narrow, in every language, light, dark and in forced colours. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { LANGUAGES } from "../src/texts/index.js";
import { broken } from "./axe.js";
import { choosePrinter, download, drop, layers, openPanel, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();
const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const DESKTOP = { viewport: { width: 1280, height: 800 } };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

const PANELS = ["cusp-settings", "cusp-orientation", "cusp-findings", "cusp-quality", "cusp-mask", "cusp-chart"];

/**
 * Layout faults after pressing each of these buttons: text that leaves its panel or overlaps, clipped options and button labels, and a page
 * wider than the window. Evaluated in the page, since there are many elements.
 */
function misfits(page: Page, pressed = "", panels: readonly string[] = PANELS): Promise<string[]> {
  return page.evaluate(
    async ([panels, pressed]) => {
      const bench = document.querySelector("cusp-workbench");
      const root = bench?.shadowRoot;
      if (!bench || !root) throw new Error("there is no page");
      const wrong: string[] = [];
      const cramped = (host: Element, say: (what: string) => void): void => {
        const roots: ShadowRoot[] = [];
        const collect = (root: ShadowRoot | null): void => {
          if (root === null) return;
          roots.push(root);
          for (const it of root.querySelectorAll("*")) collect(it.shadowRoot);
        };
        collect(host.shadowRoot);
        const { left, right } = host.getBoundingClientRect();
        const texts: { said: string; box: DOMRect }[] = [];
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
            // Long names of printers end in an ellipsis.
            if (select.id === "printer") continue;
            for (const { text } of select.selectedOptions) if (pen.measureText(text).width > room) say(`cut: ${text}`);
          }
        }
        for (const [i, { said, box }] of texts.entries()) {
          if (box.left < left - 1 || box.right > right + 1) say(`out: ${said}`);
          for (const other of texts.slice(i + 1)) {
            const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left);
            const down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
            if (across > 1 && down > 4) say(`on each other: ${said} | ${other.said}`);
          }
        }
      };
      const look = (where: string): void => {
        for (const panel of root.querySelectorAll(panels)) {
          if (panel.checkVisibility({ visibilityProperty: true })) cramped(panel, (what) => void wrong.push(`${where} ${panel.localName}: ${what}`));
        }
        const buttons = root.querySelectorAll<HTMLElement>(".path button, .bar-panels button, .step-foot button, .tab-row button");
        for (const it of buttons) {
          if (it.scrollWidth > it.clientWidth || it.getBoundingClientRect().right > innerWidth) wrong.push(`${where} ${it.innerText}`);
        }
        if (document.documentElement.scrollWidth > innerWidth) wrong.push(`${where} the page`);
      };
      if (pressed === "") look("");
      else {
        for (const button of root.querySelectorAll<HTMLElement>(pressed)) {
          button.click();
          for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
          look(button.innerText);
        }
      }
      return wrong;
    },
    [[":not(*)", ...panels].join(), pressed] as const,
  );
}

test("no text is cut, sticks out or lies on another in any language, on a desktop and on the narrowest phone", async () => {
  const page = await start("?rays=512&printer=photon-mono-m5s", { viewport: { width: 1280, height: 800 }, reducedMotion: "reduce" });
  const speak = async (code: string): Promise<void> => {
    await page.locator("select", { has: page.locator("option[lang=de]") }).selectOption(code);
    await expect.poll(() => page.locator("html").getAttribute("lang")).toMatch(new RegExp(`^${code}`));
  };
  // A very long name.
  await drop(page, { name: `${"a-very-long-name-".repeat(8)}.txt`, bytes: new Uint8Array(1) });
  await state(page, "error");
  for (const code of LANGUAGES) {
    await speak(code);
    expect(await misfits(page), code).toEqual([]);
  }
  await drop(page, { name: `${"a-very-long-name-".repeat(8)}.stl`, bytes: ball.bytes });
  await state(page, "done");
  // The printer takes one thickness; adaptive layers have more panels.
  const planners = page.locator("cusp-settings input[name=planner]");
  await expect.poll(() => planners.last().isChecked()).toBe(true);
  await planners.first().evaluate((it) => (it as HTMLInputElement).click());
  await page.locator("cusp-quality svg").waitFor();
  // The narrowest window with both sides, and the narrowest phone: wider ones have more room.
  for (const code of LANGUAGES) {
    await page.setViewportSize({ width: 1280, height: 800 });
    await speak(code);
    expect(await misfits(page, ".path button"), `${code}, 1280 px`).toEqual([]);
    await page.setViewportSize({ width: 320, height: 800 });
    expect(await misfits(page, ":is(.path, .bar-panels) button"), `${code}, 320 px`).toEqual([]);
    await page.locator("cusp-workbench .sheet").waitFor();
    // As wide as the widest system font.
    await page.evaluate(() => {
      document.documentElement.style.fontSize = "112.5%";
      document.querySelector<HTMLElement>("cusp-workbench")?.style.setProperty("--cusp-font", "monospace");
    });
    expect(await misfits(page, "", []), code).toEqual([]);
    await page.evaluate(() => {
      document.documentElement.style.fontSize = "";
      document.querySelector<HTMLElement>("cusp-workbench")?.style.removeProperty("--cusp-font");
    });
  }
});

/** Overflow of the page beyond its window, pixels. */
const overflow = (page: Page): Promise<[number, number]> =>
  page.evaluate(() => {
    const { scrollWidth, scrollHeight } = document.documentElement;
    return [scrollWidth - innerWidth, scrollHeight - innerHeight];
  });

/** Expects all of these inside the window and not clipped by a scrolling panel. */
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

test("at 1280 × 800 nothing scrolls from the drop to the download, nothing moves while a plan is made, and the view grows with the window", async () => {
  const page = await start("?rays=512", DESKTOP);
  expect(await overflow(page)).toEqual([0, 0]);
  await inSight(page, [".first h2", "[part=drop]", "#printer", "cusp-figure canvas"]);
  // Settings appear with a model.
  expect(await page.locator("#tolerance, .side").count()).toBe(0);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await page.waitForSelector(".u-over");
  await inSight(page, ["cusp-view", "cusp-layer-slider", ".u-over", "[data-layers]", ".download", "#printer", "#tolerance"]);
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
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  await inSight(page, ["cusp-view", ".download", "cusp-mask canvas"]);
  await openPanel(page, "Orient");
  await inSight(page, ["cusp-view", ".download"]);
  expect((await download(page)).suggestedFilename()).toBe("other-cusp.zip");
  expect(await overflow(page)).toEqual([0, 0]);

  const area = async (): Promise<number> => {
    const box = await page.locator("cusp-view").boundingBox();
    return (box?.width ?? 0) * (box?.height ?? 0);
  };
  const before = await area();
  for (const width of [1280, 1180]) {
    await page.setViewportSize({ width, height: 800 });
    await expect.poll(async () => (await page.locator("cusp-view").boundingBox())?.width ?? 0).toBeGreaterThanOrEqual(0.599 * width);
    const header = await page.locator("header").boundingBox();
    const view = await page.locator("[part=view]").boundingBox();
    expect(view?.height).toBeGreaterThan(800 - (header?.height ?? 0) - 4);
  }
  // The largest element on the screen.
  const others = await page.locator(".side > *").evaluateAll((them) => them.map((it) => it.clientWidth * it.clientHeight));
  expect(Math.max(...others)).toBeLessThan(before);
  await page.setViewportSize({ width: 1920, height: 1080 });
  await expect.poll(area).toBeGreaterThan(2 * before);
});

test("on a phone the view comes first, the bar stays, and panels are sheets, which give the focus back", async () => {
  const page = await start("?rays=512", PHONE);
  await drop(page, ball);
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  await inSight(page, ["cusp-view", "cusp-layer-slider", ".bar [data-layers]", ".bar .download"]);
  const whole = (await page.locator("cusp-view").boundingBox())?.height ?? 0;
  expect(whole).toBeGreaterThan(844 / 2);
  for (const name of ["Orient", "Check", "Hollow", "Support", "Slice", "Profile", "Quality", "Mask"]) {
    await page.locator("nav").getByRole("button", { name }).tap();
    await page.locator(".sheet").getByRole("heading", { name, level: 2 }).waitFor();
    await inSight(page, ["cusp-view", ".bar [data-layers]", ".bar .download"]);
    expect(await overflow(page)).toEqual([0, 0]);
  }
  expect(await broken(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  await expect.poll(async () => (await page.locator("cusp-view").boundingBox())?.height).toBe(whole);

  const focused = (): Promise<string | undefined> =>
    page.locator("cusp-workbench").evaluate(({ shadowRoot }) => shadowRoot?.activeElement?.textContent?.trim().replace(/\s+/g, " "));
  const press = (name: string): Promise<void> => page.locator(".path, .bar").getByRole("button", { name }).press("Enter");
  const open = async (name: string, title = name): Promise<void> => {
    await press(name);
    await page.locator(".sheet").getByRole("heading", { name: title, level: 2 }).waitFor();
  };
  const close = page.locator(".sheet").getByRole("button", { name: "Close" });
  for (const [way, name, title] of [
    [() => close.press("Escape"), "Slice", "Slice"],
    [() => close.press("Enter"), "Profile", "Profile"],
    [() => press("Show the result"), "Show the result", "Result"],
  ] as const) {
    await open(name, title);
    await way();
    await expect.poll(() => page.locator(".sheet").count()).toBe(0);
    expect(await focused()).toContain(name);
  }
  // From step to step: the button of the last one.
  await open("Orient");
  await page.getByRole("button", { name: "Next: Hollow" }).press("Enter");
  await page.locator(".sheet").getByRole("heading", { name: "Hollow", level: 2 }).waitFor();
  await page.keyboard.press("Escape");
  await expect.poll(focused).toContain("Hollow");
  // Elements outside the sheet keep the focus.
  await open("Slice");
  const slider = page.getByRole("slider", { name: "Layer in the view" });
  await slider.focus();
  await page.keyboard.press("Escape");
  await expect.poll(() => page.locator(".sheet").count()).toBe(0);
  expect(await page.locator("cusp-workbench").evaluate(({ shadowRoot }) => shadowRoot?.activeElement?.localName)).toBe("cusp-layer-slider");
});

test("the slider beside the view stands at the height of its layer, also where the chart is zoomed; tabs are chosen with the arrow keys", async () => {
  const page = await start("?rays=512", DESKTOP);
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
  /** Positions of the slider's thumb and the chart's marker, from the window's top. */
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

  await page.getByRole("tab", { name: "Quality" }).focus();
  await page.keyboard.press("ArrowRight");
  await page.locator("cusp-mask").waitFor();
  expect(await page.getByRole("tab", { name: "Mask" }).getAttribute("aria-selected")).toBe("true");
  await page.keyboard.press("ArrowRight");
  await page.locator("cusp-quality").waitFor();
  await page.keyboard.press("End");
  await page.locator("cusp-mask").waitFor();
});

test("an accessibility checker finds nothing amiss in any state, nor too little contrast in light or dark", async () => {
  const page = await start("?rays=512", { ...DESKTOP, reducedMotion: "reduce" });
  const checked = async (what: string): Promise<void> => {
    expect(await broken(page), what).toEqual([]);
  };
  const checkedDark = async (what: string): Promise<void> => {
    await checked(what);
    await page.emulateMedia({ colorScheme: "dark" });
    expect(await broken(page, ["color-contrast"]), `${what}, dark`).toEqual([]);
    await page.emulateMedia({ colorScheme: "light" });
  };
  await drop(page, { name: "notes.txt", bytes: new Uint8Array(1) });
  await state(page, "error");
  await checkedDark("a file that will not do");
  await drop(page, ball);
  await state(page, "done");
  await openPanel(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
  await checked("Check");
  await openPanel(page, "Support");
  await checked("Support");
  await openPanel(page, "Orient");
  await page.getByRole("button", { name: "Find the best orientation" }).click();
  await page.locator("cusp-orientation .pose").first().waitFor();
  await page.getByRole("application", { name: "Sphere of directions" }).press("ArrowRight");
  await page.getByRole("button", { name: "Use this orientation" }).waitFor();
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  await checkedDark("directions and masks");

  await openPanel(page, "Slice");
  await page.getByLabel("Tolerance", { exact: true }).fill("0.02");
  await state(page, "error");
  await page.getByLabel("Thinnest layer").fill("x");
  await expect.poll(() => page.getByLabel("Thinnest layer").getAttribute("aria-invalid")).toBe("true");
  await checked("no plan, and no number");
  await page.getByLabel("Thinnest layer").fill("0.02");
  await page.getByLabel("Measure errors by").selectOption("volume");
  await page.getByText("More settings").click();
  await page.locator("details.figures summary").click();
  await choosePrinter(page, "mono m5s");
  await page.getByText("so they are uniform").waitFor();
  await page.getByText("Adaptive", { exact: true }).click();
  await settled(page);
  await page.locator(".warning .offers button").waitFor();
  await choosePrinter(page, "own printer of mine");
  await page.getByLabel("Open its description").waitFor({ state: "attached" });
  await checkedDark("all settings, and a warning");
});

test("forced colours reach the chart, and what is chosen or wrong is told without colour", async () => {
  const page = await start("?rays=512");
  await drop(page, ball);
  await state(page, "done");
  /** Number of canvas pixels in a system colour. */
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

  const paper = await page.evaluate(() => {
    const probe = document.body.appendChild(document.createElement("span"));
    probe.style.backgroundColor = "Canvas";
    return getComputedStyle(probe).backgroundColor;
  });
  await page.locator("cusp-quality .curve").waitFor();
  for (const selector of [".curve", ".dot", ".base"]) {
    expect(await page.locator(`cusp-quality ${selector}`).first().evaluate((it) => getComputedStyle(it).stroke), selector).not.toBe(paper);
  }
  const form = page.locator("cusp-settings");
  const [chosen, other] = await form.locator(".choice").first().locator("label").evaluateAll((labels) => labels.map((it) => getComputedStyle(it).backgroundColor));
  expect(chosen).not.toBe(other);
  await page.getByLabel("Tolerance", { exact: true }).fill("x");
  await page.getByLabel("Tolerance", { exact: true }).blur();
  await form.locator(".box.wrong").waitFor();
  expect(await form.locator(".box.wrong").evaluate((it) => getComputedStyle(it).outlineStyle)).toBe("solid");
});
