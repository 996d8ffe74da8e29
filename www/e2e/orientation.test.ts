/** The orientation search, as a user runs it. */
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import { binaryStl, exampleTriangles } from "../src/page/example.js";
import { drop, layers, openPanel, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { cup, sphere } from "./solids.js";

const start = pages();

const panel = (page: Page): Locator => page.locator("cusp-orientation");
const disc = (page: Page, side: "Front" | "Back"): Locator =>
  panel(page).locator("figure").filter({ hasText: side }).locator(".disc");

const mug = { name: "mug.stl", bytes: cup(20, 30, 2) };

async function opened(query: string, file = mug): Promise<Page> {
  const page = await start(`?backend=cpu&rays=512${query}`, { reducedMotion: "reduce" });
  await drop(page, file);
  await state(page, "done");
  await openPanel(page, "Orient");
  return page;
}

async function search(page: Page): Promise<void> {
  await panel(page).getByRole("button", { name: /Find the best orientation|Search again/ }).click();
  await searched(page);
}

async function searched(page: Page): Promise<void> {
  await panel(page).getByRole("button", { name: /Find the best orientation|Search again/ }).waitFor();
}

interface Seen {
  colours: number;
  grey: number;
  clear: number;
}

/** Fractions of a disc's picture that are grey and clear, and the number of its colours. */
function seen(page: Page, side: "Front" | "Back"): Promise<Seen> {
  return disc(page, side)
    .locator("canvas")
    .evaluate((it) => {
      const canvas = it as HTMLCanvasElement;
      const pixels = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      const colours = new Set<number>();
      const count = { grey: 0, clear: 0 };
      for (let at = 0; at < pixels.length; at += 4) {
        const [r = 0, g = 0, b = 0, alpha = 0] = [pixels[at], pixels[at + 1], pixels[at + 2], pixels[at + 3]];
        if (alpha === 0) count.clear++;
        else if (Math.max(r, g, b) - Math.min(r, g, b) < 24) count.grey++;
        else colours.add((r << 16) | (g << 8) | b);
      }
      const whole = pixels.length / 4;
      return { colours: colours.size, grey: count.grey / whole, clear: count.clear / whole };
    });
}

/** A point on the front within grey: offset from the centre, in radii. */
function greyAt(page: Page): Promise<readonly [number, number]> {
  return disc(page, "Front")
    .locator("canvas")
    .evaluate((it) => {
      const canvas = it as HTMLCanvasElement;
      const side = canvas.width;
      const pixels = canvas.getContext("2d")?.getImageData(0, 0, side, side).data ?? [];
      const isGrey = (x: number, y: number): boolean => {
        const [r = 0, g = 0, b = 0, alpha = 0] = [0, 1, 2, 3].map((channel) => pixels[4 * (y * side + x) + channel]);
        return alpha === 255 && Math.max(r, g, b) - Math.min(r, g, b) < 24;
      };
      const reach = Math.round(side / 80);
      for (let y = reach; y < side - reach; y++) {
        for (let x = reach; x < side - reach; x++) {
          const around = [-reach, 0, reach].flatMap((dy) => [-reach, 0, reach].map((dx) => isGrey(x + dx, y + dy)));
          if (around.every(Boolean)) return [(2 * x) / side - 1, 1 - (2 * y) / side] as const;
        }
      }
      throw new Error("nothing is grey");
    });
}

/** Centre of a disc, moved by fractions of its radius. */
async function at(page: Page, side: "Front" | "Back", right: number, up: number): Promise<{ x: number; y: number }> {
  const it = disc(page, side);
  await it.scrollIntoViewIfNeeded();
  const box = await it.boundingBox();
  if (box === null) throw new Error("the sphere is not there");
  return { x: box.x + ((1 + right) * box.width) / 2, y: box.y + ((1 - up) * box.height) / 2 };
}

const figure = async (page: Page, name: string): Promise<string> =>
  (await panel(page).locator(".looked div").filter({ has: page.locator("dt", { hasText: name }) }).locator("dd").innerText()).replace(",", "");

test("a search fills the sphere and offers three directions; they are applied by button, pointer and keys, and the sphere turns along", async () => {
  const page = await opened("", { name: "goblet.stl", bytes: binaryStl(exampleTriangles()) });
  await page.evaluate(() => {
    document.querySelector("cusp-workbench")?.addEventListener("cusp-orientation", ({ detail }) => {
      document.documentElement.dataset["promised"] = String(detail.metrics?.layers);
    });
  });
  const before = await layers(page);
  await search(page);
  for (const side of ["Front", "Back"] as const) {
    const { colours, clear } = await seen(page, side);
    expect(colours, side).toBeGreaterThan(30);
    // The area outside the disc, and nothing inside it.
    expect(Math.abs(clear - (1 - Math.PI / 4)), side).toBeLessThan(0.02);
  }
  const poses = panel(page).locator(".pose");
  expect(await poses.count()).toBe(3);
  const picture = (): Promise<string> => disc(page, "Front").locator("canvas").evaluate((it) => (it as HTMLCanvasElement).toDataURL());
  const unturned = await picture();
  // The current pose is a card next to them.
  const now = async (): Promise<number> => Number((await panel(page).locator(".now strong").innerText()).replace(/\D/g, ""));
  expect(await now()).toBe(before);
  // Each says how it differs from the current one, and all figures are those of the pose under the pointer, or of the current one.
  expect(await poses.nth(0).locator(".differs").count()).toBeGreaterThan(0);
  expect(Number(await figure(page, "Layers"))).toBe(before);
  for (const pose of await poses.all()) {
    await pose.hover();
    expect(`${await figure(page, "Layers")} layers`).toBe(await pose.locator("strong").innerText());
  }

  const third = poses.nth(2);
  await third.click();
  await settled(page);
  await expect.poll(picture).not.toBe(unturned);
  expect(await panel(page).locator(".up path").count()).toBeGreaterThan(0);
  await expect.poll(() => third.getAttribute("aria-pressed")).toBe("true");
  await expect.poll(() => layers(page)).not.toBe(before);
  const promised = Number(await page.locator("html").getAttribute("data-promised"));
  // The rotation is written with six digits, so a flat may fall on the other side of a bin boundary.
  expect(Math.abs((await layers(page)) - promised)).toBeLessThanOrEqual(1);
  await expect.poll(now).toBe(promised);
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await layers(page)).toBe(before);

  // By pointing, which shows its metrics, and clicking.
  const { x, y } = await at(page, "Front", 0.5, -0.3);
  await page.mouse.move(x, y);
  const shown = (): Promise<string | null> => panel(page).locator("[data-direction]").getAttribute("data-direction");
  const first = await shown();
  const pointed = Number(await figure(page, "Layers"));
  expect(await figure(page, "Size")).toMatch(/mm$/);
  expect(Number(await figure(page, "Score"))).toBeGreaterThan(0);
  // Another place is another direction.
  const elsewhere = await at(page, "Back", 0.2, 0.1);
  await page.mouse.move(elsewhere.x, elsewhere.y);
  await expect.poll(shown).not.toBe(first);
  await page.mouse.move(x, y);
  await expect.poll(shown).toBe(first);
  await page.mouse.click(x, y);
  await settled(page);
  await page.getByRole("button", { name: "As in the file" }).waitFor();
  expect(Math.abs((await layers(page)) - pointed)).toBeLessThanOrEqual(1);
  expect(pointed).not.toBe(before);

  // Again by keyboard, with the pointer elsewhere.
  await page.mouse.move(0, 0);
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await layers(page)).toBe(before);
  await panel(page).getByRole("application", { name: "Sphere of directions" }).focus();
  const passed = new Set<string | null>();
  await page.keyboard.press("ArrowDown");
  passed.add(await shown());
  for (let i = 0; i < 5; i++) {
    await page.keyboard.press(i % 2 === 0 ? "ArrowRight" : "ArrowDown");
    const before = [...passed];
    await expect.poll(async () => before.includes(await shown())).toBe(false);
    passed.add(await shown());
  }
  const next = Number(await figure(page, "Layers"));
  await page.keyboard.press("Enter");
  await settled(page);
  await page.getByRole("button", { name: "As in the file" }).waitFor();
  expect(Math.abs((await layers(page)) - next)).toBeLessThanOrEqual(1);
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);

  // What counts can change without new measurements; relevant settings make the search outdated.
  await panel(page).locator("summary").click();
  await panel(page).getByLabel("Overhang", { exact: true }).focus();
  await page.keyboard.press("End");
  await expect.poll(picture).not.toBe(unturned);
  await searched(page);
  const outdated = panel(page).getByText("Found with settings");
  expect(await outdated.count()).toBe(0);
  await openPanel(page, "Slice");
  await page.getByLabel("Tolerance", { exact: true }).fill("0.08");
  await settled(page);
  await openPanel(page, "Orient");
  await outdated.waitFor();
});

test("directions that do not fit the printer are grey, and say why", async () => {
  // As high as the printer allows when upright; tilted, it is too large.
  const page = await opened("&printer=mars-4-ultra&height=115");
  await search(page);
  const { grey } = await seen(page, "Front");
  expect(grey).toBeGreaterThan(0.01);
  const [right, up] = await greyAt(page);
  const { x, y } = await at(page, "Front", right, up);
  await page.mouse.move(x, y);
  await panel(page).getByText(/Too (wide|high)/).first().waitFor();
  const before = await layers(page);
  await page.mouse.click(x, y);
  await settled(page);
  expect(await layers(page)).toBe(before);
});

test("a search is cancelled by its button and by Escape, and leaves what it measured", async () => {
  const page = await opened("", { name: "ball.stl", bytes: sphere(10, 400).bytes });
  const find = panel(page).getByRole("button", { name: "Find the best orientation" });
  await find.click();
  await panel(page).getByRole("progressbar").waitFor();
  // Waits for the first visible results.
  await expect.poll(async () => (await seen(page, "Front")).clear).toBeLessThan(0.99);
  await panel(page).getByRole("button", { name: "Cancel" }).click();
  await find.waitFor();
  expect(await panel(page).locator(".pose").count()).toBe(0);
  expect((await seen(page, "Front")).clear).toBeLessThan(0.99);
  await find.click();
  await panel(page).getByRole("progressbar").waitFor();
  await page.keyboard.press("Escape");
  await find.waitFor();
  // The existing plan is not touched.
  expect(await layers(page)).toBeGreaterThan(0);
});
