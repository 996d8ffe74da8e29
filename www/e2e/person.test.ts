/** A person's way over the page, from a first visit to a file: by mouse, by keyboard, and by touch on a phone. */
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { downloaded, drop, layers, openPanel, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";
import { SOFTWARE_GL } from "./view-pages.js";

const start = pages(SOFTWARE_GL);
const ball = { name: "ball.stl", bytes: sphere(10, 96).bytes };

/** How a person reaches for things. */
interface Hand {
  name: string;
  options: Parameters<typeof start>[1];
  press(target: Locator): Promise<void>;
  panel(page: Page, name: string): Promise<void>;
  /** Goes to a layer near the bottom with the slider beside the view. */
  slide(page: Page): Promise<void>;
}

const slider = (page: Page): Locator => page.getByRole("slider", { name: "Layer in the view" });

/** Where the slider's lower end is, in the window. */
async function lowEnd(page: Page): Promise<{ x: number; y: number }> {
  const box = await slider(page).boundingBox();
  if (box === null) throw new Error("there is no slider");
  return { x: box.x + box.width / 2, y: box.y + box.height - 30 };
}

/** Moves the focus with Tab alone, as a person without a mouse does. */
async function tabTo(target: Locator): Promise<void> {
  const page = target.page();
  for (let i = 0; i < 80; i++) {
    if (await target.evaluate((element) => (element.getRootNode() as Document | ShadowRoot).activeElement === element)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error("Tab does not get there");
}

const HANDS: readonly Hand[] = [
  {
    name: "mouse",
    options: { viewport: { width: 1280, height: 800 } },
    press: (target) => target.click(),
    panel: openPanel,
    slide: async (page) => {
      const { x, y } = await lowEnd(page);
      await page.mouse.click(x, y);
    },
  },
  {
    name: "keyboard",
    options: { viewport: { width: 1280, height: 800 } },
    press: async (target) => {
      await tabTo(target);
      await target.page().keyboard.press((await target.getAttribute("type")) === "radio" || (await target.getAttribute("role")) === "switch" ? "Space" : "Enter");
    },
    panel: async (page, name) => {
      const step = page.locator("nav").getByRole("button", { name });
      if ((await step.count()) > 0) {
        await tabTo(step);
        return page.keyboard.press("Enter");
      }
      const tab = page.getByRole("tab", { name });
      const chosen = page.getByRole("tablist").filter({ has: tab }).getByRole("tab", { selected: true });
      await tabTo(chosen);
      while ((await tab.getAttribute("aria-selected")) !== "true") await page.keyboard.press("ArrowRight");
    },
    slide: async (page) => {
      await tabTo(slider(page));
      await page.keyboard.press("Home");
      await page.keyboard.press("PageUp");
    },
  },
  {
    name: "touch",
    options: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
    press: (target) => target.tap(),
    panel: async (page, name) => page.locator("nav").getByRole("button", { name }).tap(),
    slide: async (page) => {
      const { x, y } = await lowEnd(page);
      await page.touchscreen.tap(x, y);
    },
  },
];

test.each(HANDS)("from a first visit to the file, by $name", async ({ options, press, panel, slide }) => {
  const page = await start("?backend=cpu&rays=512", { ...options, reducedMotion: "reduce" });
  await press(page.getByRole("button", { name: "Try the example" }));
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  const usual = await layers(page);

  await slide(page);
  await expect.poll(() => slider(page).getAttribute("aria-valuetext")).toMatch(/^Layer [1-9]\d? of/);

  await press(page.getByRole("switch", { name: "As printed" }));
  await expect.poll(() => page.getByRole("switch", { name: "As printed" }).isChecked()).toBe(true);
  await press(page.getByRole("switch", { name: "As printed" }));

  await panel(page, "Slice");
  const tolerance = page.getByLabel("Tolerance", { exact: true });
  // As a person has it from a data sheet.
  await tolerance.fill("80 µm");
  await settled(page);
  expect(await layers(page)).toBeLessThan(usual);

  await panel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");

  const [download] = await Promise.all([
    page.waitForEvent("download"),
    press(page.getByRole("button", { name: "Download print file" })),
  ]);
  expect(download.suggestedFilename()).toBe("goblet-cusp.zip");
});

test("the plan of the example is one click from a first visit", async () => {
  const page = await start("", {}, true);
  await page.evaluate(() => localStorage.clear());
  await page.reload();
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  expect(await layers(page)).toBeGreaterThan(0);
  // The tour that comes with a first plan is beside it, not before it.
  await page.locator("cusp-tour .card").waitFor();
  expect((await downloaded(page)).name).toBe("goblet-cusp.zip");
});

test("with a printer that is remembered, its file is one click from the drop", async () => {
  const page = await start("?backend=cpu", {}, true);
  await page.getByLabel("Printer", { exact: true }).selectOption("mars-4-ultra");
  await expect.poll(() => page.evaluate(() => location.search)).toContain("mars-4-ultra");
  await page.goto(new URL("?backend=cpu", page.url()).href);
  await state(page, "empty");
  await drop(page, ball);
  await state(page, "done");
  expect((await downloaded(page)).name).toBe("ball-cusp.goo");
});
