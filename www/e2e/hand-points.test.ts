/** Support points and drain holes, placed by hand with real pointer events and keys: the plan follows. */
import { readFile } from "node:fs/promises";
import type { Locator, Page } from "playwright-core";
import { expect, test } from "vitest";
import type { CuspView } from "../src/view/cusp-view.js";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { broken } from "./axe.js";
import { drop, sceneBox, settled, SOFTWARE_GL, state } from "./browser.js";
import { pages } from "./pages.js";
import { prism, sphere } from "./solids.js";

const start = pages(SOFTWARE_GL);

/** A view that is quick to draw in software. */
const SMALL = { viewport: { width: 1280, height: 500 }, deviceScaleFactor: 0.5 };

const RADIUS = 10;
const ball = { name: "ball.stl", bytes: sphere(RADIUS, 48).bytes };

type Triple = readonly [number, number, number];

async function opened(query: string, tool: string): Promise<Page> {
  const page = await start(`?backend=cpu&rays=512${query}`, SMALL);
  await drop(page, ball);
  await state(page, "done");
  await page.getByRole("radio", { name: tool }).click();
  await page.locator("cusp-model section.points").waitFor();
  return page;
}

/** Points of the plan's supports. */
const supported = (page: Page): Promise<Triple[]> =>
  page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models[0]?.supported?.points.map(({ at_mm }) => at_mm) ?? []);

const drains = (page: Page): Promise<{ at_mm: Triple; direction: Triple; diameter_mm: number }[]> =>
  page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models[0]?.hollowed?.drains ?? []);

const query = (page: Page): URLSearchParams => new URL(page.url()).searchParams;

const count = (page: Page, name: string): Promise<string> => page.locator("section.points dl div", { hasText: name }).locator("dd").innerText();

/** A point of the view, given as fractions of its width and height. */
async function placeIn(view: Locator, x: number, y: number): Promise<[number, number]> {
  const box = await sceneBox(view);
  return [box.x + x * box.width, box.y + y * box.height];
}

/** Returns true if the pointer is on a marker there. */
async function isMarker(page: Page, at: readonly [number, number]): Promise<boolean> {
  await page.mouse.move(...at);
  return page.locator("cusp-view .scene.over").count().then((count) => count > 0);
}

/** Position of the marker above a point of the view. */
async function markerAbove(page: Page, [x, from]: readonly [number, number]): Promise<[number, number]> {
  const found: number[] = [];
  for (let y = from; y > 0; y -= 10) {
    if (await isMarker(page, [x, y])) found.push(y);
    else if (found.length > 0) return [x, ((found[0] ?? 0) + (found.at(-1) ?? 0)) / 2];
  }
  throw new Error("there is no marker");
}

const radius = ([x, y, z]: Triple): number => Math.hypot(x, y, z - RADIUS);

test("a click adds the first point, a drag moves it along the surface, a key deletes it, and all is undone", async () => {
  const page = await opened("", "Supports");
  const view = page.locator("cusp-view");
  const middle = await placeIn(view, 0.5, 0.55);
  await page.mouse.click(...middle);
  await settled(page);
  // Only that point, since no others were requested.
  expect(await supported(page)).toHaveLength(1);
  const [first] = await supported(page);
  if (first === undefined) throw new Error("the point is not in the plan");
  expect(radius(first)).toBeCloseTo(RADIUS, 1);
  // On the visible side.
  expect(first[1]).toBeLessThan(0);
  expect([query(page).get("supports"), query(page).get("points")?.split(";")]).toEqual(["medium", [expect.stringMatching(/,,1$/)]]);
  expect([await count(page, "By hand"), await count(page, "Automatic")]).toEqual(["1", "0"]);
  await page.getByText("Point 1 of 1, at").waitFor();
  expect(await broken(page)).toEqual([]);

  // The model was lifted, and the marker with it.
  const at = await markerAbove(page, middle);
  await page.mouse.move(...at);
  await page.mouse.down();
  await page.mouse.move(at[0] + 10, at[1] + 10, { steps: 3 });
  await page.mouse.move(at[0] + 40, at[1] + 20, { steps: 3 });
  await page.keyboard.press("Escape");
  await page.mouse.up();
  expect(await isMarker(page, at)).toBe(true);
  await page.mouse.move(...at);
  await page.mouse.down();
  await page.mouse.move(at[0] + 40, at[1] + 20, { steps: 3 });
  await page.mouse.up();
  await settled(page);
  const [second] = await supported(page);
  if (second === undefined) throw new Error("the moved point is not in the plan");
  expect(second).not.toEqual(first);
  expect(radius(second)).toBeCloseTo(RADIUS, 1);
  expect(await isMarker(page, at)).toBe(false);
  expect(await isMarker(page, [at[0] + 40, at[1] + 20])).toBe(true);

  await page.keyboard.press("Delete");
  await settled(page);
  expect(await supported(page)).toEqual([]);
  expect(query(page).has("points")).toBe(false);
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await supported(page)).toEqual([second]);
});

test("points are placed, chosen, locked and deleted by keyboard; those of a turned and scaled model are on its surface", async () => {
  const page = await opened("&height=30&rotation=0.5,0.5,0.5,0.5", "Supports");
  await page.locator("cusp-view .scene").focus();
  // Turn to see it from below: no support reaches its top.
  for (let i = 0; i < 4; i++) await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Enter");
  const radii = async (): Promise<number[]> => (await supported(page)).map(([x, y, z]) => Math.hypot(x, y, z - 15));
  await expect.poll(radii).toEqual([expect.closeTo(15, 1)]);
  await page.keyboard.press("Shift+ArrowLeft");
  await page.keyboard.press("Shift+ArrowLeft");
  await page.keyboard.press("Enter");
  await expect.poll(() => supported(page)).toHaveLength(2);
  await page.getByText("Point 2 of 2, at").waitFor();
  await page.keyboard.press("ArrowRight");
  await page.getByText("Point 1 of 2, at").waitFor();
  await page.keyboard.press("l");
  await expect.poll(() => page.getByRole("checkbox", { name: "Locked" }).isChecked()).toBe(false);
  // The panel is redrawn repeatedly during planning.
  await page.getByLabel("Diameter (mm)").fill("0.8");
  await settled(page);
  expect(await page.getByLabel("Diameter (mm)").inputValue()).toBe("0.8");
  await page.keyboard.press("Enter");
  const sizes = (): Promise<(number | null)[] | undefined> =>
    page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models[0]?.supported?.points.map(({ contact_mm }) => contact_mm ?? null).sort());
  await expect.poll(sizes).toEqual([0.8, null]);
  await page.locator("cusp-view .scene").focus();
  await page.keyboard.press("Backspace");
  await expect.poll(() => supported(page)).toHaveLength(1);
});

test("a hole is drilled into a hollow model by a click, inward, and its plug is saved as an STL; weights that points and holes keep off are shown", async () => {
  const page = await opened("&supports=light&wall=1.5", "Drains");
  const automatic = await drains(page);
  expect(automatic.length).toBeGreaterThan(0);
  const view = page.locator("cusp-view");
  expect(await view.evaluate((it: CuspView) => (it.voids?.length ?? 0) > 9)).toBe(true);
  await page.getByLabel("Diameter of new holes (mm)").fill("2.5");
  await page.mouse.click(...(await placeIn(view, 0.5, 0.45)));
  await settled(page);
  const after = await drains(page);
  expect(after).toHaveLength(automatic.length + 1);
  const own = after.find(({ diameter_mm }) => diameter_mm === 2.5);
  if (own === undefined) throw new Error("the hole is not in the plan");
  expect(radius(own.at_mm)).toBeCloseTo(RADIUS, 1);
  // Towards the centre of the ball, up to the facet's slope.
  const [x, y, z] = own.at_mm;
  expect((own.direction[0] * -x + own.direction[1] * -y + own.direction[2] * (RADIUS - z)) / RADIUS).toBeGreaterThan(0.98);
  expect(query(page).get("drain")).toBe("none");
  const button = page.getByRole("button", { name: "Download plugs (STL)" });
  const [file] = await Promise.all([page.waitForEvent("download"), button.click()]);
  expect(file.suggestedFilename()).toBe("ball-plugs.stl");
  const plugs = await readFile(await file.path());
  const facets = plugs.readUInt32LE(80);
  expect(plugs).toHaveLength(84 + 50 * facets);
  expect([facets > 0, facets % after.length]).toEqual([true, 0]);
  expect(await broken(page)).toEqual([]);

  // While supports and holes avoid large weights, the view shows the weights.
  const shown = (): Promise<readonly [string, string]> => page.locator("cusp-view").evaluate(({ look, heat }: CuspView) => [look, heat] as const);
  const protect = page.getByRole("switch", { name: "Keep points and holes off what is painted as important" });
  expect(await protect.isDisabled()).toBe(true);
  await page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
    const facets = element.model?.info.facets ?? 0;
    element.weights = Float32Array.from({ length: facets }, (_, facet) => (facet % 2 === 0 ? 1 : 0.2));
  });
  await settled(page);
  expect(await shown()).toEqual(["thickness", "product"]);
  await page.getByRole("button", { name: "Place automatically" }).click();
  await settled(page);
  await protect.check();
  await settled(page);
  expect(await shown()).toEqual(["weights", "product"]);
  const asked = (): Promise<unknown> =>
    page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => {
      const { supports, hollow } = element.result?.options ?? {};
      return [supports?.protect, hollow?.auto_drain];
    });
  expect(await asked()).toEqual([true, { protect: true }]);
  await page.getByRole("radio", { name: "Supports" }).check();
  expect(await protect.isChecked()).toBe(true);
  expect(await shown()).toEqual(["weights", "product"]);
  await page.locator("cusp-view .legend").waitFor();
  expect(await broken(page)).toEqual([]);
  await protect.uncheck();
  await settled(page);
  expect(await asked()).toEqual([undefined, {}]);
  expect((await shown())[0]).toBe("thickness");
});

test("of several models each has points of its own, placed on it alone; its copies follow, and it keeps them while others are selected", async () => {
  const page = await start("?backend=cpu&printer=mars-4-ultra&rays=512&supports=light", SMALL);
  await drop(page, ball, { name: "block.stl", bytes: prism(12, 8).bytes });
  await state(page, "done");
  const points = (): Promise<number[]> =>
    page.locator("cusp-workbench").evaluate((element: CuspWorkbench) => element.result?.report.models.map(({ supported }) => supported?.points.length ?? 0) ?? []);
  const before = await points();
  expect(Math.min(...before)).toBeGreaterThan(0);
  const tool = page.getByRole("radio", { name: "Supports" });
  await tool.click();
  await page.locator("cusp-model section.points").waitFor();
  // The ball alone, in the middle.
  expect(await page.locator("cusp-view").evaluate((it: CuspView) => it.copies.length)).toBe(0);
  await page.mouse.click(...(await placeIn(page.locator("cusp-view"), 0.5, 0.55)));
  await settled(page);
  const after = [(before[0] ?? 0) + 1, before[1]];
  expect(await points()).toEqual(after);
  await page.getByRole("button", { name: "One more: Copies of ball.stl" }).click();
  await settled(page);
  expect(await points()).toEqual(after);
  await page.getByRole("button", { name: "block.stl", exact: true }).click();
  await settled(page);
  expect(await points()).toEqual(after);
  await page.getByRole("button", { name: "ball.stl", exact: true }).click();
  await settled(page);
  expect(await points()).toEqual(after);
  expect(query(page).get("points")?.split(";")).toHaveLength(after[0] ?? 0);
  // The ball stands on the plate then, and the block keeps its supports.
  await page.locator("section.points").getByRole("button", { name: "Clear" }).click();
  await settled(page);
  expect(await points()).toEqual([0, before[1]]);
});
