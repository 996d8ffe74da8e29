/** How thick the model is, as the view draws it. */
import { expect, it } from "vitest";
import { colourAt } from "../src/view/legend/palette.js";
import { drawn, likeness, picture, viewPages, type Pixel } from "./view-pages.js";

const start = viewPages();

/** Colours count as the same from this likeness on. */
const SAME = 0.99;

it("the top of a table is coloured by what is under each place of it, and striped where that is too little", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    // A top of 1 mm, over legs of 3 mm more along two of its sides.
    const { box } = harness.solids;
    const parts = [box([0, 0, 3], [20, 20, 4]), box([0, 0, 0], [5, 20, 3]), box([15, 0, 0], [20, 20, 3])];
    harness.show();
    await harness.set({ positions: Float32Array.from(parts.flatMap((part) => [...part])), look: "walls", tool: "turn", showsLegend: false });
  });
  await page.locator("cusp-view .legend.walls").waitFor();
  // From above.
  await page.locator("cusp-view .scene").focus();
  for (let i = 0; i < 12; i++) await page.keyboard.press("ArrowUp");
  await drawn(page);
  const box = await page.locator("cusp-view").boundingBox();
  const [x, y] = [(box?.width ?? 0) / 2, (box?.height ?? 0) / 2];
  // The thickness as a fraction of the scale, which ends at 4 mm: its first colour is the thinnest.
  const [thin, thick] = [colourAt("safe", 0.25), colourAt("safe", 1)];
  const middle = async (): Promise<Pixel> => (await picture(page))(x, y);
  expect(likeness(await middle(), thin)).toBeGreaterThan(SAME);
  expect(likeness(await middle(), thick)).toBeLessThan(SAME);
  const marked = async (): Promise<number> => {
    const at = await picture(page);
    return Array.from({ length: 30 }, (_, i) => at(x + i, y)).filter(([r, g, b]) => r > 2 * g && r > 2 * b).length;
  };
  expect(await marked()).toBe(0);
  await page.evaluate(() => window.harness.set({ wall_mm: 1.2 }));
  // Red, with a third of it in stripes.
  expect(await marked()).toBeGreaterThan(12);
  expect(await marked()).toBeLessThan(28);
  // Twice as large, it is thick enough.
  await page.evaluate(() => window.harness.set({ scale: 2 }));
  expect(await marked()).toBe(0);
});

it("a model that comes while the last one is being measured has its own walls", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.ball(10, 300), look: "walls" });
    await harness.set({ positions: harness.solids.box([0, 0, 0], [10, 10, 2]) });
  });
  await page.locator("cusp-view .legend.walls").waitFor();
  expect(await page.evaluate(() => window.harness.view.walls?.grids.length)).toBe(24);
  await page.waitForTimeout(500);
  expect(await page.evaluate(() => window.harness.view.walls?.grids.length)).toBe(24);
});
