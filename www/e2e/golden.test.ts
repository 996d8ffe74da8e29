/** Compares the page with recorded pictures of it: `npm run goldens` records them again. */
import type { BrowserContextOptions, Page, PageScreenshotOptions } from "playwright-core";
import { expect, test } from "vitest";
import { downloaded, drop, openPanel, settled, state } from "./browser.js";
import { difference, golden, goldenFonts, isAlike, keep, record, recordFonts, small, TOLERANCE } from "./golden.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";
import { SOFTWARE_GL } from "./view-pages.js";

const isRecording = process.env["BLESS"] === "1";

const SIZES = {
  phone: { width: 390, height: 844 },
  tablet: { width: 820, height: 1180 },
  desktop: { width: 1280, height: 800 },
  large: { width: 1920, height: 1080 },
} as const;

const LIGHT = { colorScheme: "light" } as const;
const DARK = { colorScheme: "dark" } as const;
const FORCED = { colorScheme: "dark", forcedColors: "active" } as const;

/** Every size in light; the other themes change colours, which two sizes show. */
const LOOKS: Readonly<Record<string, BrowserContextOptions>> = {
  "phone-light": { viewport: SIZES.phone, ...LIGHT },
  "tablet-light": { viewport: SIZES.tablet, ...LIGHT },
  "desktop-light": { viewport: SIZES.desktop, ...LIGHT },
  "large-light": { viewport: SIZES.large, ...LIGHT },
  "phone-dark": { viewport: SIZES.phone, ...DARK },
  "desktop-dark": { viewport: SIZES.desktop, ...DARK },
  "phone-forced": { viewport: SIZES.phone, ...FORCED },
  "desktop-forced": { viewport: SIZES.desktop, ...FORCED },
};

/** How often in a row the picture must be the same to count as still. */
const STILL = 3;

async function example(page: Page): Promise<void> {
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  // It appears with the first frame of the plan.
  await page.locator("cusp-view .label:not([hidden])").waitFor();
  // The last thing to appear is the curve, and with it the quality slider.
  if (await page.locator("cusp-quality").count()) await expect.poll(() => page.locator("cusp-quality input[type=range]").count()).toBe(1);
}

interface Visit {
  query?: string;
  /** The looks that it is made in; all by default. */
  looks?: RegExp;
  /** The states that the page goes through, and how each is reached from the one before. */
  states: Readonly<Record<string, (page: Page) => Promise<void>>>;
}

const VISITS: readonly Visit[] = [
  {
    states: {
      empty: async () => undefined,
      done: example,
      mask: async (page) => {
        await openPanel(page, "Mask");
        await page.waitForSelector("canvas[data-layer]");
      },
      settings: async (page) => {
        await openPanel(page, "Slice");
        await page.getByText("More settings").click();
        await page.getByText("Uniform", { exact: true }).click();
        await settled(page);
      },
    },
  },
  {
    // No plan keeps this tolerance: the page says so beside the field, and offers what would help.
    query: "&metric=cusp&tolerance=0.02",
    states: {
      error: async (page) => {
        await drop(page, { name: "ball.stl", bytes: sphere(10, 96).bytes });
        await state(page, "error");
        await page.locator("cusp-view .grid").waitFor();
      },
    },
  },
  {
    states: {
      orientation: async (page) => {
        await example(page);
        await openPanel(page, "Turn");
        await page.getByRole("button", { name: "Find the best orientation" }).click();
        await expect.poll(() => page.locator("cusp-orientation .pose canvas[data-drawn]").count()).toBe(3);
      },
    },
  },
  {
    states: {
      printed: async (page) => {
        await example(page);
        await page.getByRole("switch", { name: "As printed" }).click();
      },
    },
  },
  {
    // The example's own print file, dropped again. Software takes long over its many facets: not more often than needed.
    query: "&printer=ld-002h",
    looks: /^(phone|desktop)-(light|dark)$/,
    states: {
      print: async (page) => {
        await example(page);
        await drop(page, { ...(await downloaded(page)), name: "goblet.ctb" });
        await page.locator("cusp-print canvas[data-layer]").waitFor();
        // Software draws the many facets whenever it can; `printed` has a picture of the view.
        await page.locator("cusp-print cusp-view").evaluate((view) => (view.style.visibility = "hidden"));
      },
    },
  },
];

const sizeOf = (title = ""): string | undefined => Object.keys(SIZES).find((size) => title.includes(`-${size}-`));

const namesOf = ({ states }: Visit): string[] => Object.keys(states);

/** Widths of some letters in the page's font: other fonts break lines elsewhere, and no picture would match its golden. */
function widths(): string {
  const pen = document.createElement("canvas").getContext("2d");
  if (pen === null) return "";
  const { fontFamily } = getComputedStyle(document.body);
  const texts = ["Hamburgefonstiv 0123456789", "Schichtdicke – épaisseur – 层厚"];
  const fonts = [`16px ${fontFamily}`, `bold 16px ${fontFamily}`];
  return fonts
    .flatMap((font) => {
      pen.font = font;
      return texts.map((text) => pen.measureText(text).width.toFixed(2));
    })
    .join(" ");
}

/** The whole page, once nothing on it moves any more. */
async function still(page: Page): Promise<Uint8Array> {
  await page.evaluate(() => document.fonts.ready);
  // How long a plan took varies, but is folded away by default.
  const options: PageScreenshotOptions = { fullPage: true, animations: "disabled" };
  let before = await page.screenshot(options);
  for (let same = 1; same < STILL; ) {
    const now = await page.screenshot(options);
    same = now.equals(before) ? same + 1 : 1;
    before = now;
  }
  return before;
}

const start = pages(SOFTWARE_GL);

/** Fails the test if the page differs from its golden; records the golden if that was asked for. */
async function compare(page: Page, title: string): Promise<void> {
  const screenshot = await still(page);
  const actual = small(screenshot);
  if (isRecording) await record(title, actual);
  const before = await golden(title);
  if (before === null) throw new Error(`there is no golden of ${title}: npm run goldens records it`);
  const found = difference(before, actual);
  if (isAlike(found)) return;
  const folder = await keep(title, screenshot, actual);
  // Softly, so that the states after this one are looked at, too.
  expect.soft(found, `${title} is more than ${JSON.stringify(TOLERANCE)} off: see ${folder}`).toBeNull();
}

for (const [look, options] of Object.entries(LOOKS)) {
  const titled = VISITS.filter(({ looks }) => looks?.test(look) ?? true).map((visit) => [namesOf(visit).join(", "), visit] as const);
  test.for(titled)(`%s, ${look}, looks as it did`, async ([, { query = "", states }], context) => {
    const page = await start(`?backend=cpu${query}`, { ...options, reducedMotion: "reduce" });
    const fonts = await page.evaluate(widths);
    if (isRecording) await recordFonts(fonts);
    else if (fonts !== (await goldenFonts())) {
      const reason = "the goldens were recorded with other fonts than are here";
      Object.assign(context.task.meta, { reason });
      return context.skip(reason);
    }
    for (const [name, reach] of Object.entries(states)) {
      await reach(page);
      await compare(page, `${name}-${look}`);
    }
  });
}

test("what is tolerated is less than what tells any two goldens of the same size apart", async () => {
  const titles = Object.keys(LOOKS).flatMap((look) => VISITS.flatMap(namesOf).map((name) => `${name}-${look}`));
  const pictures = await Promise.all(titles.map(golden));
  for (const [i, one] of pictures.entries()) {
    for (const [j, other] of pictures.entries()) {
      if (i === j || one === null || other === null || sizeOf(titles[i]) !== sizeOf(titles[j])) continue;
      expect(isAlike(difference(one, other)), `${titles[i]} and ${titles[j]}`).toBe(false);
    }
  }
});
