/** The panel of the view, in a real browser: its bar, its layout, and how it stays aligned with a plot. */
import { decode } from "fast-png";
import type { Page } from "playwright-core";
import { describe, expect, it } from "vitest";
import { LANGUAGES } from "../src/texts/index.js";
import { broken } from "./axe.js";
import { drawn, viewPages } from "./view-pages.js";

const start = viewPages();

interface Wanted {
  locale?: string;
  hasPlot?: boolean;
  style?: Record<string, string>;
  /** Corners around the model: from 316 on it is a large one. */
  around?: number;
  layer_mm?: number;
}

/** Shows the panel with a cone whose sides fall by 45°. */
const show = (page: Page, { layer_mm = 0.2, around = 64, ...wanted }: Wanted = {}): Promise<void> =>
  page.evaluate(
    async ([wanted, layer_mm, around]) => {
      const { harness } = window;
      const z_mm = Array.from({ length: Math.round(10 / layer_mm) + 1 }, (_, i) => i * layer_mm);
      const positions = around > 315 ? harness.solids.ball(5, around) : harness.solids.cone(10, 10, around);
      await harness.showPanel({ positions, z_mm, ...wanted });
    },
    [wanted, layer_mm, around] as const,
  );

const withoutGl = (): void => {
  const before = HTMLCanvasElement.prototype.getContext as (...given: unknown[]) => unknown;
  Object.assign(HTMLCanvasElement.prototype, {
    getContext(this: HTMLCanvasElement, kind: string, ...given: unknown[]) {
      return kind === "webgl2" ? null : before.call(this, kind, ...given);
    },
  });
};

describe("the bar", () => {
  it("has modes, of which one is on, and switches, all of them for the keyboard too", async () => {
    const page = await start();
    await show(page, { hasPlot: true });
    const tool = (): Promise<string | undefined> => page.evaluate(() => window.harness.inner?.tool);
    await page.getByRole("radio", { name: "Look around" }).focus();
    await page.keyboard.press("ArrowRight");
    expect(await tool()).toBe("rotate");
    await page.keyboard.press("ArrowRight");
    expect(await tool()).toBe("flat");
    expect(await page.getByRole("radio", { checked: true }).count()).toBe(1);
    // One stop for all modes, one for each switch.
    await page.keyboard.press("Tab");
    for (const name of ["Beside the profile", "As printed", "Distance from the model", "Colour-blind safe"]) {
      const it = page.getByRole("switch", { name });
      expect(await it.evaluate((it) => it === (it.getRootNode() as ShadowRoot).activeElement), name).toBe(true);
      const before = await it.isChecked();
      await page.keyboard.press("Space");
      expect(await it.isChecked(), name).toBe(!before);
      await page.keyboard.press("Tab");
    }
    expect(await page.evaluate(() => window.harness.inner?.palette)).toBe("safe");
    expect(await broken(page)).toEqual([]);
  });

  it("takes the view out of alignment for the printed look, and back", async () => {
    const page = await start();
    await show(page, { hasPlot: true });
    const [printed, measured, aligned] = ["As printed", "Distance from the model", "Beside the profile"].map((name) =>
      page.getByRole("switch", { name }),
    ) as [ReturnType<Page["getByRole"]>, ReturnType<Page["getByRole"]>, ReturnType<Page["getByRole"]>];
    const states = async (): Promise<boolean[]> => Promise.all([printed, measured, aligned].map((it) => it.isChecked()));
    expect(await states()).toEqual([false, false, true]);
    await measured.click();
    expect(await states()).toEqual([true, true, false]);
    await measured.click();
    expect(await states()).toEqual([true, false, false]);
    await printed.click();
    expect(await states()).toEqual([false, false, true]);
    await printed.click();
    await aligned.click();
    expect(await states()).toEqual([false, false, true]);
    await page.getByRole("radio", { name: "What matters" }).click();
    expect(await states()).toEqual([false, false, false]);
    await aligned.click();
    expect(await states()).toEqual([false, false, true]);
    expect(await page.getByRole("radio", { name: "Look around" }).isChecked()).toBe(true);
  });

  it("is one line from 560 pixels on, and nothing is cut at 260, in all languages", async () => {
    const page = await start({ viewport: { width: 2000, height: 800 } });
    for (const locale of LANGUAGES) {
      // The widths at which names appear are the tightest.
      for (const width of [260, 560, 992, 1728]) {
        // The chart at its side takes 8 rem.
        await show(page, { locale, hasPlot: true, style: { width: `${width + 128}px` } });
        await page.evaluate(async () => {
          window.harness.panel.rotation = [1, 0, 0, 0];
          await window.harness.panel.updateComplete;
        });
        const found = await page.evaluate(() => {
          const bar = window.harness.panel.shadowRoot?.querySelector<HTMLElement>(".bar");
          if (!bar) throw new Error("there is no bar");
          const targets = [...bar.querySelectorAll<HTMLElement>("label, button")].map((it) => it.getBoundingClientRect());
          const { left, right } = bar.getBoundingClientRect();
          return {
            width: right - left,
            switches: bar.querySelectorAll(".switch:not(.unseen)").length,
            height: bar.offsetHeight,
            isInside: targets.every((it) => it.left >= left && it.right <= right),
            least: Math.min(...targets.flatMap((it) => [it.width, it.height])),
          };
        });
        const at = `${locale} at ${width}`;
        expect(found, at).toMatchObject({ width, switches: 4, isInside: true });
        expect(found.least, at).toBeGreaterThanOrEqual(36);
        expect(found.height, at).toBeLessThanOrEqual(width === 260 ? 80 : 40);
      }
    }
  });

  it("is as high with the chart at the view's side as with the chart elsewhere, so that neither undoes itself", async () => {
    const page = await start();
    // The last switch just fits, or just does not.
    for (let width = 330; width <= 430; width += 10) {
      await show(page, { hasPlot: true, style: { width: `${width + 128}px` } });
      const height = (): Promise<number | undefined> =>
        page.evaluate(() => window.harness.panel.shadowRoot?.querySelector<HTMLElement>(".bar")?.offsetHeight);
      const beside = await height();
      await page.evaluate(() => (window.harness.plot.style.display = "none"));
      await drawn(page);
      await drawn(page);
      expect(await page.getByRole("switch").count()).toBe(3);
      expect(await height(), String(width)).toBe(beside);
      await page.evaluate(() => (window.harness.plot.style.display = ""));
    }
  });

  it("is disabled with the reason where there is no WebGL", async () => {
    const page = await start({ before: withoutGl });
    await show(page).catch(() => undefined);
    const controls = page.locator("cusp-model .bar input");
    await expect.poll(() => controls.evaluateAll((all) => all.every((it) => (it as HTMLInputElement).disabled))).toBe(true);
    expect(await controls.count()).toBe(7);
    const reason = page.getByText("These tools need the 3-D view, which is not available.");
    expect(await reason.isVisible()).toBe(true);
    const id = await reason.getAttribute("id");
    expect(await controls.evaluateAll((all) => all.map((it) => it.getAttribute("aria-describedby")))).toEqual(Array(7).fill(id));
    await page.getByText("WebGL 2 is switched off or missing").waitFor();
    expect(await broken(page)).toEqual([]);
  });
});

describe("the layout", () => {
  const heights = (page: Page): Promise<{ panel: number; view: number; width: number; tools: number; lowest: number }> =>
    page.evaluate(() => {
      const { panel, inner } = window.harness;
      const tools = panel.shadowRoot?.querySelector(".paint")?.getBoundingClientRect();
      const view = inner?.getBoundingClientRect();
      return {
        panel: panel.offsetHeight,
        view: view?.height ?? 0,
        width: view?.width ?? 0,
        tools: tools?.height ?? 0,
        lowest: Math.max(view?.bottom ?? 0, tools?.bottom ?? 0) - panel.getBoundingClientRect().top,
      };
    });

  it.each([650, 390, 260])("keeps the model visible with the brush in a box %i pixels wide and 650 high", async (width) => {
    const page = await start({ viewport: { width: 800, height: 700 } });
    await show(page, { style: { width: `${width}px`, height: "650px" } });
    const plain = await heights(page);
    expect(plain.panel).toBe(650);
    expect(plain.view).toBeGreaterThan(540);
    await page.getByRole("radio", { name: "What matters" }).click();
    await page.getByText("Load weights").waitFor();
    await drawn(page);
    const { view, width: across, tools, lowest } = await heights(page);
    expect(view).toBeGreaterThanOrEqual(350);
    expect(across).toBeGreaterThan(width === 650 ? 350 : width - 1);
    expect(tools).toBeGreaterThan(140);
    expect(lowest).toBeLessThanOrEqual(650);
    // All tools can be reached.
    await page.getByText("Load weights").scrollIntoViewIfNeeded();
    expect(await page.getByText("Load weights").isVisible()).toBe(true);
  });

  it("makes its own height in a card, and the tools add to it where they are below", async () => {
    const page = await start({ viewport: { width: 400, height: 700 } });
    await show(page);
    const plain = await heights(page);
    expect(plain.view).toBe(448);
    await page.getByRole("radio", { name: "What matters" }).click();
    await page.getByText("Load weights").waitFor();
    await drawn(page);
    const open = await heights(page);
    expect(open.view).toBe(448);
    expect(open.panel).toBeGreaterThan(plain.panel + 300);
  });
});

describe("forced colours", () => {
  it("show what is on, the scale and its mark, and draw the plate in the system's ink", async () => {
    const page = await start({ before: () => undefined });
    await page.emulateMedia({ forcedColors: "active" });
    await show(page);
    const found = await page.evaluate(() => {
      const { panel, inner } = window.harness;
      const system = (name: string): string => {
        const probe = document.createElement("span");
        document.body.append(probe);
        probe.style.setProperty("forced-color-adjust", "none");
        probe.style.color = name;
        const { color } = getComputedStyle(probe);
        probe.remove();
        return color;
      };
      const style = (root: ShadowRoot | null | undefined, query: string): CSSStyleDeclaration => {
        const it = root?.querySelector(query);
        if (it == null) throw new Error(`there is no ${query}`);
        return getComputedStyle(it);
      };
      return {
        mode: [style(panel.shadowRoot, ".mode:has(:checked)").backgroundColor, system("Highlight")],
        other: [style(panel.shadowRoot, ".mode:not(:has(:checked))").backgroundColor !== system("Highlight"), true],
        track: [style(panel.shadowRoot, ".track").borderTopColor, system("CanvasText")],
        knob: [getComputedStyle(panel.shadowRoot?.querySelector(".track") ?? document.body, "::before").backgroundColor, system("CanvasText")],
        scale: [style(inner?.shadowRoot, ".scale").backgroundImage.startsWith("linear-gradient"), true],
        mark: [style(inner?.shadowRoot, ".mark").backgroundColor, system("CanvasText")],
        ink: [style(inner?.shadowRoot, ".ink").color, system("CanvasText")],
        accent: [style(inner?.shadowRoot, ".accent").color, system("Highlight")],
        background: [getComputedStyle(inner ?? document.body).backgroundImage, "none"],
      };
    });
    for (const [name, [is, wanted]] of Object.entries(found)) expect(is, name).toBe(wanted);
  });
});

describe("the printed look", () => {
  /** Rows of the middle column at which a tread begins below a wall, in the middle half of the picture. */
  const treads = async (page: Page): Promise<number[]> => {
    const { data, width, height, channels } = decode(await page.locator("cusp-view canvas").screenshot());
    const column = Math.round(width / 2);
    const rows = Array.from({ length: Math.round(height / 2) }, (_, i) => i + Math.round(height / 4));
    const light = (row: number): number => data[channels * (row * width + column)] ?? 0;
    const middle = (Math.min(...rows.map(light)) + Math.max(...rows.map(light))) / 2;
    // Treads face upwards and are lighter.
    return rows.filter((row) => light(row) > middle && light(row - 1) <= middle);
  };
  const canvas = (page: Page): Promise<Buffer> => page.locator("cusp-view canvas").screenshot();
  const ready = async (page: Page): Promise<void> => {
    await page.waitForTimeout(300);
    await page.waitForFunction(() => window.harness.inner?.building === null);
    await drawn(page);
    await drawn(page);
  };
  const printed = (page: Page): Promise<void> => page.getByRole("switch", { name: "As printed" }).click();

  it("comes so near that steps can be told apart, and goes back to where it was", async () => {
    const page = await start();
    await show(page, { layer_mm: 0.05, around: 256 });
    const before = await canvas(page);
    // From afar a layer covers two pixels.
    await printed(page);
    await ready(page);
    const found = await treads(page);
    expect(found.length).toBeGreaterThan(8);
    for (const [i, row] of found.slice(1).entries()) expect(row - (found[i] ?? 0)).toBeGreaterThanOrEqual(6);
    await printed(page);
    await drawn(page);
    await expect.poll(async () => (await canvas(page)).equals(before)).toBe(true);
  });

  it("stays where the person went meanwhile", async () => {
    const page = await start();
    await show(page, { layer_mm: 0.05 });
    const scene = page.locator("cusp-view .scene");
    const whole = async (): Promise<Buffer> => {
      await scene.focus();
      await page.keyboard.press("0");
      await drawn(page);
      return canvas(page);
    };
    const before = await whole();
    await printed(page);
    await ready(page);
    await scene.focus();
    await page.keyboard.press("ArrowLeft");
    await printed(page);
    await scene.focus();
    await drawn(page);
    expect((await canvas(page)).equals(before)).toBe(false);
    expect((await whole()).equals(before)).toBe(true);
  });

  it("leaves the chart's side for that, and comes back there", async () => {
    const page = await start();
    await show(page, { layer_mm: 0.05, hasPlot: true });
    const before = await canvas(page);
    await printed(page);
    await ready(page);
    expect((await treads(page)).length).toBeGreaterThan(8);
    await printed(page);
    await drawn(page);
    await expect.poll(async () => (await canvas(page)).equals(before)).toBe(true);
  });
});

describe("a change of layout", () => {
  /** Notes what was wrong in each frame that the browser has painted. */
  interface Noted {
    readonly wrong: string[];
    frames: number;
  }

  /** Whether the canvas has been cleared, by a new size, since it was drawn on. */
  const watchClearing = (): void => {
    const size = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, "width");
    const cleared = new WeakSet<HTMLCanvasElement>();
    Object.assign(window, { cleared });
    Object.defineProperty(HTMLCanvasElement.prototype, "width", {
      ...size,
      set(this: HTMLCanvasElement, value: number) {
        size?.set?.call(this, value);
        cleared.add(this);
      },
    });
    const context = WebGL2RenderingContext.prototype;
    for (const name of ["drawArrays", "drawElements"] as const) {
      const before = context[name] as (...given: unknown[]) => void;
      Object.assign(context, {
        [name](this: WebGL2RenderingContext, ...given: unknown[]) {
          before.apply(this, given);
          if (this.getParameter(this.FRAMEBUFFER_BINDING) === null) cleared.delete(this.canvas as HTMLCanvasElement);
        },
      });
    }
  };

  /** Changes the layout a step in each frame, and looks at each frame after it was painted. */
  const through = (page: Page, isLarge = false): Promise<Noted> =>
    page.evaluate(async (isLarge) => {
      const { harness } = window;
      const { inner, panel, plot } = harness;
      const { cleared } = window as unknown as { cleared: WeakSet<HTMLCanvasElement> };
      const canvas = inner?.shadowRoot?.querySelector("canvas");
      const frame = document.querySelector<HTMLElement>(".frame");
      const card = document.querySelector<HTMLElement>(".card");
      if (!inner || !canvas || !frame || !card) throw new Error("there is no view");
      type Rows = { top_px: number; bottom_px: number } | null;
      let rows: Rows = null;
      inner.addEventListener("cusp-frame", ({ detail }) => (rows = detail));
      const noted: Noted = { wrong: [], frames: 0 };
      // The event tells only changes.
      panel.shadowRoot?.querySelector<HTMLInputElement>("[role=switch]")?.click();
      await harness.drawn();
      panel.shadowRoot?.querySelector<HTMLInputElement>("[role=switch]")?.click();
      await harness.drawn();
      const look = (step: string): void => {
        noted.frames++;
        const [view, chart, picture] = [inner, plot, canvas].map((it) => it.getBoundingClientRect()) as [DOMRect, DOMRect, DOMRect];
        const isBeside = chart.height > 0 && chart.top >= view.top - 1 && chart.bottom <= view.bottom + 1;
        if (cleared.has(canvas)) noted.wrong.push(`${step}: empty`);
        const [wide, high] = [canvas.width / picture.width, canvas.height / picture.height];
        if (Math.abs(wide - high) > 0.01 || Math.abs(wide - devicePixelRatio) > 0.01) noted.wrong.push(`${step}: stretched`);
        // A picture of a large model comes later; it must not be a wrong one, but it may be the old one.
        if (isLarge) return;
        if (Math.abs(picture.width - view.width) > 1 || Math.abs(picture.height - view.height) > 1) noted.wrong.push(`${step}: of another size`);
        if (isBeside !== (rows !== null)) noted.wrong.push(`${step}: ${isBeside ? "not " : ""}aligned`);
        if (isBeside && rows !== null) {
          const [up, down] = [view.top + rows.top_px - chart.top, view.top + rows.bottom_px - chart.bottom];
          if (Math.abs(up) > 1 || Math.abs(down) > 1) noted.wrong.push(`${step}: off by ${up.toFixed(1)} and ${down.toFixed(1)}`);
        }
      };
      const steps: [string, () => void][] = [];
      for (let width = 640; width >= 520; width -= 10) steps.push([`${width} wide`, () => (frame.style.width = `${width}px`)]);
      for (let height = 500; height <= 620; height += 10) steps.push([`${height} high`, () => (frame.style.height = `${height}px`)]);
      for (let height = 320; height >= 200; height -= 10) steps.push([`plot ${height} high`, () => (plot.style.height = `${height}px`)]);
      steps.push(["below", () => (frame.style.gridTemplate = "none")]);
      steps.push(["beside", () => (frame.style.gridTemplate = "")]);
      steps.push(["chart gone", () => (plot.style.display = "none")]);
      steps.push(["chart there", () => (plot.style.display = "")]);
      steps.push(["a panel open", () => (card.style.paddingTop = "3rem")]);
      for (const [step, change] of steps) {
        await new Promise<void>((done) => {
          requestAnimationFrame(() => {
            change();
            // Arrives when the frame has been painted.
            const { port1, port2 } = new MessageChannel();
            port1.onmessage = () => {
              look(step);
              done();
            };
            port2.postMessage(null);
          });
        });
      }
      return noted;
    }, isLarge);

  it("shows no frame that is empty, stretched, in the wrong projection or beside the heights of the plot", async () => {
    const page = await start({ before: watchClearing, viewport: { width: 900, height: 800 } });
    await show(page, { hasPlot: true, style: { width: "650px", height: "500px" } });
    const { wrong, frames } = await through(page);
    expect(frames).toBeGreaterThan(40);
    expect(wrong).toEqual([]);
  });

  it("shows no empty or stretched frame of a large model either", async () => {
    const page = await start({ before: watchClearing, viewport: { width: 900, height: 800 } });
    await show(page, { hasPlot: true, around: 320, style: { width: "650px", height: "500px" } });
    // Until the first picture is there.
    await page.waitForFunction(() => {
      const canvas = window.harness.inner?.shadowRoot?.querySelector("canvas");
      return canvas != null && !(window as unknown as { cleared: WeakSet<object> }).cleared.has(canvas);
    });
    expect((await through(page, true)).wrong).toEqual([]);
  });

  it("makes no loop of resizing at any width", async () => {
    const page = await start({ before: () => {
      const said: string[] = [];
      Object.assign(window, { said });
      window.addEventListener("error", ({ message }) => said.push(`${innerWidth}: ${message}`));
    } });
    await show(page, { hasPlot: true, locale: "de" });
    // At 450 the plot goes from below to beside.
    for (let width = 435; width <= 465; width++) {
      await page.setViewportSize({ width, height: 640 });
      await drawn(page);
    }
    expect(await page.evaluate(() => (window as unknown as { said: string[] }).said)).toEqual([]);
  });
});

describe("fingers", () => {
  type Finger = readonly [x: number, y: number];
  const gesture = async (page: Page, ...stages: Finger[][]): Promise<void> => {
    const session = await page.context().newCDPSession(page);
    const touch = (type: "touchStart" | "touchMove" | "touchEnd", fingers: Finger[]): Promise<unknown> =>
      session.send("Input.dispatchTouchEvent", { type, touchPoints: fingers.map(([x, y], id) => ({ x, y, id })) });
    const [first = [], ...rest] = stages;
    await touch("touchStart", first);
    for (const fingers of rest) await touch("touchMove", fingers);
    await touch("touchEnd", []);
    await drawn(page);
  };
  const canvas = (page: Page): Promise<Buffer> => page.locator("cusp-view canvas").screenshot();
  const up: Finger[][] = [[[150, 300]], [[150, 280]], [[150, 240]], [[150, 200]]];
  const options = { hasTouch: true, viewport: { width: 390, height: 400 } };

  it("turn the view freely where the host says that the page does not scroll", async () => {
    const page = await start(options);
    await show(page);
    await page.evaluate(() => document.documentElement.style.setProperty("--cusp-view-touch", "none"));
    const before = await canvas(page);
    await page.evaluate(() => scrollTo(0, 0));
    await gesture(page, ...up);
    expect(await page.evaluate(() => scrollY)).toBe(0);
    expect((await canvas(page)).equals(before)).toBe(false);
  });

  it("in pairs move the view and leave the page where it is", async () => {
    const page = await start(options);
    await show(page);
    const before = await canvas(page);
    await page.evaluate(() => scrollTo(0, 0));
    await gesture(page, ...up.map(([[x, y] = [0, 0]]): Finger[] => [[x, y], [x + 80, y]]));
    expect(await page.evaluate(() => scrollY)).toBe(0);
    expect((await canvas(page)).equals(before)).toBe(false);
  });
});
