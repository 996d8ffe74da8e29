/** The 3-D view and its panel alone: drawing and interaction. */
import { decode } from "fast-png";
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { LANGUAGES } from "../src/texts/index.js";
import { colourAt } from "../src/view/legend/palette.js";
import { broken } from "./axe.js";
import { drawn, forget, heard, likeness, picture, said, viewPages, type Pixel } from "./view-pages.js";

const start = viewPages();

/** Minimum likeness of colours that count as equal. */
const SAME = 0.995;

/** Waits for more frames than a change needs. */
async function settled(page: Page): Promise<void> {
  for (let i = 0; i < 10; i++) await drawn(page);
}

test("layers have the colours of the palette, each at its height, exact to one among 2,000", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({
      positions: harness.solids.cone(10, 20, 64),
      z_mm: [0, 12, 20],
      thickness_mm: [12, 8],
      limits: [8, 12],
      aligned: true,
      showsLegend: false,
    });
  });
  const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
  const at = await picture(page);
  const row = (z: number): number => frame.bottom_px + (z / 20) * (frame.top_px - frame.bottom_px);
  const middle = ((await page.locator("cusp-view").boundingBox())?.width ?? 0) / 2;
  const [thin, thick] = [colourAt(0), colourAt(1)];
  for (const z of [1, 6, 11.7]) expect(likeness(at(middle, row(z)), thick), `at ${z} mm`).toBeGreaterThan(SAME);
  for (const z of [12.3, 15, 18]) expect(likeness(at(middle, row(z)), thin), `at ${z} mm`).toBeGreaterThan(SAME);
  expect(likeness(thin, thick)).toBeLessThan(SAME);
  // Next to the cone, where it has become narrow, there is only background.
  expect(at(middle + 150, row(19))).toEqual(at(middle - 150, row(19)));
  expect(likeness(at(middle + 150, row(19)), thin)).toBeLessThan(SAME);
  const thickness = (layer: number): number => (layer % 3 === 0 ? 0.03 : 0.05);
  const z_mm = [0];
  for (let layer = 0; layer < 2000; layer++) z_mm.push((z_mm[layer] ?? 0) + thickness(layer));
  const height = z_mm.at(-1) ?? 0;
  await page.evaluate(
    async ([boundaries, top]) => {
      const { harness } = window;
      await harness.set({
        positions: harness.solids.box([0, 0, 0], [10, 10, top]),
        z_mm: boundaries,
        thickness_mm: boundaries.slice(1).map((z, i) => z - (boundaries[i] ?? 0)),
        limits: [0.03, 0.05],
        aligned: true,
        showsLegend: false,
        inset: { top_px: 0, bottom_px: 0 },
      });
    },
    [z_mm, height] as const,
  );
  for (const first of [0, 1990]) {
    const [bottom, top] = [z_mm[first] ?? 0, z_mm[first + 10] ?? 0];
    await page.evaluate((heights_mm) => window.harness.set({ heights_mm }), [bottom, top] as const);
    const at = await picture(page);
    const box = await page.locator("cusp-view").boundingBox();
    for (let layer = first; layer < first + 10; layer++) {
      const middle = ((z_mm[layer] ?? 0) + (z_mm[layer + 1] ?? 0)) / 2;
      const row = (1 - (middle - bottom) / (top - bottom)) * (box?.height ?? 0);
      const wanted = colourAt(layer % 3 === 0 ? 0 : 1);
      expect(likeness(at((box?.width ?? 0) / 2, row), wanted), `layer ${layer}`).toBeGreaterThan(SAME);
    }
  }
});

/** Counts uploads to the GPU. */
const counting = (): void => {
  const counts: Record<string, number> = {};
  Object.assign(window, { counts });
  const context = WebGL2RenderingContext.prototype as unknown as Record<string, (...given: unknown[]) => unknown>;
  for (const name of ["drawArrays", "drawElements", "bufferData", "bufferSubData", "texSubImage2D", "texImage2D"]) {
    const before = context[name];
    if (before === undefined) continue;
    context[name] = function (this: unknown, ...given) {
      counts[name] = (counts[name] ?? 0) + 1;
      return before.apply(this, given);
    };
  }
};

test("the view draws when something has changed, and a new plan sends no geometry", async () => {
  const page = await start({ before: counting });
  const counts = (): Promise<Record<string, number>> =>
    page.evaluate(() => {
      const { counts: now } = window as unknown as { counts: Record<string, number> };
      const before = { ...now };
      for (const name of Object.keys(now)) now[name] = 0;
      return before;
    });
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.ball(10, 32), z_mm: [0, 12, 20], thickness_mm: [12, 8], limits: [8, 12] });
  });
  await settled(page);
  expect((await counts())["drawArrays"]).toBeGreaterThan(0);
  await settled(page);
  expect(Object.values(await counts()).filter((count) => count > 0)).toEqual([]);
  await page.evaluate(() => window.harness.set({ z_mm: [0, 8, 16, 20], thickness_mm: [8, 8, 4], limits: [4, 8] }));
  const after = await counts();
  expect(after["drawArrays"]).toBeGreaterThan(0);
  expect((after["texSubImage2D"] ?? 0) + (after["texImage2D"] ?? 0)).toBe(1);
  expect((after["bufferData"] ?? 0) + (after["bufferSubData"] ?? 0)).toBe(0);
});

test("the view says that the GPU was lost, goes on once it is found or when it is asked to, and leaves nothing behind when it goes", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.ball(10, 32), z_mm: [0, 12, 20], thickness_mm: [12, 8], limits: [8, 12] });
  });
  const before = await picture(page);
  const [x, y] = [200, 220];
  const lose = (): Promise<void> =>
    page.evaluate(() => {
      const lose = window.harness.view.shadowRoot?.querySelector("canvas")?.getContext("webgl2")?.getExtension("WEBGL_lose_context");
      lose?.loseContext();
      Object.assign(window, { restore: () => lose?.restoreContext() });
    });
  const alert = page.locator("cusp-view").getByRole("alert");
  await lose();
  await expect.poll(() => alert.innerText()).toContain("The browser has stopped the 3-D view.");
  // Nothing is found under the pointer, and no promise stays pending.
  await page.mouse.move(x, y);
  await page.mouse.click(x, y);
  expect(await broken(page)).toEqual([]);
  await page.evaluate("restore()");
  await alert.waitFor({ state: "detached" });
  await settled(page);
  expect((await picture(page))(x, y)).toEqual(before(x, y));

  await lose();
  await alert.getByRole("button", { name: "Show again" }).click();
  await alert.waitFor({ state: "detached" });
  await settled(page);
  expect((await picture(page))(x, y)).toEqual(before(x, y));

  const alive = await page.evaluate(async () => {
    const { harness } = window;
    const lost: boolean[] = [];
    for (let i = 0; i < 3; i++) {
      const context = harness.view.shadowRoot?.querySelector("canvas")?.getContext("webgl2");
      harness.view.remove();
      lost.push(context?.isContextLost() ?? false);
      harness.show();
      await harness.drawn();
    }
    return lost.filter((gone) => !gone).length;
  });
  expect(alive).toBe(0);
  expect((await picture(page))(x, y)).toEqual(before(x, y));
});

test("the view holds no more on the GPU after six models than after two", async () => {
  const page = await start({
    before: () => {
      const live = { count: 0 };
      Object.assign(window, { live });
      const context = WebGL2RenderingContext.prototype as unknown as Record<string, (...given: unknown[]) => unknown>;
      for (const thing of ["Buffer", "Texture", "Framebuffer", "VertexArray"]) {
        for (const [name, by] of [[`create${thing}`, 1], [`delete${thing}`, -1]] as const) {
          const before = context[name];
          if (before === undefined) continue;
          context[name] = function (this: unknown, ...given) {
            live.count += by;
            return before.apply(this, given);
          };
        }
      }
    },
  });
  const after = (models: number, from: number): Promise<number> =>
    page.evaluate(
      async ([count, first]) => {
        const { harness } = window;
        for (let i = 0; i < count; i++) {
          const height = 2 * (first + i + 5);
          const z_mm = Array.from({ length: height + 1 }, (_, layer) => layer);
          const thickness_mm = z_mm.slice(1).map(() => 1);
          await harness.set({ positions: harness.solids.ball(height / 2, 32), z_mm, thickness_mm, look: "printed" });
          await new Promise((resolve) => setTimeout(resolve, 200));
          while (harness.view.building !== null) await new Promise((resolve) => setTimeout(resolve, 5));
          await harness.set({ tool: "rotate" });
          await harness.set({ tool: "turn" });
        }
        return (window as unknown as { live: { count: number } }).live.count;
      },
      [models, from] as const,
    );
  await page.evaluate(() => window.harness.show());
  const few = await after(2, 0);
  expect(few).toBeGreaterThan(5);
  // One or two come and go with the drawing; with a leak, four would remain.
  expect(Math.abs((await after(4, 2)) - few)).toBeLessThanOrEqual(2);
});

test("the view shows the whole model at any size until somebody moves it, in the page's theme", async () => {
  const page = await start({ viewport: { width: 436, height: 448 } });
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.ball(10, 32), showsLegend: false });
  });
  /** Returns true if the model reaches the edge of the view. */
  const isCut = async (): Promise<boolean> => {
    const { width = 0, height = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
    const at = await picture(page);
    // The model is much darker than the background.
    return at(3, height / 2)[0] - at(width / 2, height / 2)[0] < 30;
  };
  await expect.poll(isCut).toBe(false);
  await page.setViewportSize({ width: 260, height: 448 });
  await expect.poll(isCut).toBe(false);
  await page.locator("cusp-view .scene").focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press("+");
  await page.setViewportSize({ width: 240, height: 448 });
  await expect.poll(isCut).toBe(true);
  const light = (await picture(page))(120, 200);
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(async () => (await picture(page))(120, 200)[0]).toBeLessThan(light[0]);
  await page.emulateMedia({ colorScheme: null });
});

test("the printed look has the steps of the layers, and their distances from the model are on the legend and in the colours", async () => {
  const page = await start();
  // A cone whose sides fall by 45°.
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({
      positions: harness.solids.cone(10, 10, 256),
      z_mm: [0, 5, 10],
      thickness_mm: [5, 5],
      limits: [5, 5],
      look: "printed",
      aligned: true,
      showsLegend: false,
    });
  });
  const across = async (z: number): Promise<number> => {
    const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
    const perMm = (frame.bottom_px - frame.top_px) / 10;
    const at = await picture(page);
    const box = await page.locator("cusp-view").boundingBox();
    const row = frame.bottom_px - z * perMm;
    const [empty] = at(4, row);
    let count = 0;
    for (let x = 0; x < (box?.width ?? 0); x++) if (Math.abs(at(x, row)[0] - empty) > 12) count++;
    return count / perMm;
  };
  const done = async (): Promise<void> => {
    // The steps start shortly after a change.
    await page.waitForTimeout(300);
    await page.waitForFunction(() => window.harness.view.building === null && window.harness.view.measuring === null);
    await drawn(page);
  };
  await done();
  const plain = await picture(page);
  // Vertical walls: sections at the middles of the layers have 7.5 mm and 2.5 mm of radius.
  for (const z of [0.5, 4.5]) expect(Math.abs((await across(z)) - 15)).toBeLessThan(0.4);
  for (const z of [5.5, 9.5]) expect(Math.abs((await across(z)) - 5)).toBeLessThan(0.4);
  expect(await page.locator("cusp-view .legend").count()).toBe(0);
  await page.evaluate(() => window.harness.set({ look: "distance" }));
  await done();
  const ticks = await page.locator("cusp-view .ticks span").allInnerTexts();
  // Half a layer's thickness times |n_z|, in µm; the corners of the cone's base are at 256.
  const largest = Number(ticks.at(-1)?.replace(",", ""));
  expect(ticks[0]).toBe("0");
  expect(Math.abs(largest - 2500 * Math.SQRT1_2)).toBeLessThan(2);
  const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
  const { width = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
  const coloured = await picture(page);
  const row = (z: number): number => frame.bottom_px + (z / 10) * (frame.top_px - frame.bottom_px);
  const at = (z: number): [number, number] => [width / 2, row(z)];
  // A wall is on the cone half-way up, and farthest from it at its top.
  expect(likeness(coloured(...at(2.5)), colourAt(1))).toBeGreaterThan(0.98);
  expect(likeness(coloured(...at(4.9)), colourAt(0))).toBeGreaterThan(0.98);
  for (const z of [2.5, 4.9]) expect(likeness(coloured(...at(z)), plain(...at(z)))).toBeLessThan(0.98);
  // Distances are kept with the steps, not measured again.
  await page.evaluate(() => window.harness.set({ look: "printed" }));
  expect((await picture(page))(...at(4.9))).toEqual(plain(...at(4.9)));
  await page.evaluate(() => window.harness.set({ look: "distance" }));
  expect((await picture(page))(...at(4.9))).toEqual(coloured(...at(4.9)));
  // Another plan has other distances.
  await page.evaluate(() => window.harness.set({ z_mm: [0, 2, 4, 6, 8, 10], thickness_mm: [2, 2, 2, 2, 2] }));
  expect(await page.locator("cusp-view .legend").count()).toBe(0);
  await done();
  const other = Number((await page.locator("cusp-view .ticks span").last().innerText()).replace(",", ""));
  expect(Math.abs(other - 1000 * Math.SQRT1_2)).toBeLessThan(2);
});

test("the top of a table is coloured by what is under each place of it, and striped where that is too little", async () => {
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
  const [thin, thick] = [colourAt(0.25), colourAt(1)];
  const middle = async (): Promise<Pixel> => (await picture(page))(x, y);
  expect(likeness(await middle(), thin)).toBeGreaterThan(0.99);
  expect(likeness(await middle(), thick)).toBeLessThan(0.99);
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

test("what is found is painted on the surface, and on a plate on its own copy alone", async () => {
  const page = await start();
  /** Pixels of the colour of findings in the left and in the right half. */
  const painted = async (): Promise<[number, number]> => {
    await drawn(page);
    const at = await picture(page);
    const count: [number, number] = [0, 0];
    for (let x = 0; x < 400; x += 2) {
      for (let y = 0; y < 400; y += 2) if (likeness(at(x, y), [255, 159, 26]) > 0.98) count[x < 200 ? 0 : 1]++;
    }
    return count;
  };
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.box([-5, -5, 0], [5, 5, 10]) });
  });
  expect(await painted()).toEqual([0, 0]);
  // The lower half of a box: half of what is seen of its sides. Outlines alone are a fiftieth of that.
  const whole = async (high: number): Promise<number> => {
    await page.evaluate((high) => window.harness.set({ places: [{ at_mm: [0, 0, 0], bounds_mm: [[-5, -5, 0], [5, 5, high]] }] }), high);
    const [left, right] = await painted();
    return left + right;
  };
  const [lower, all] = [await whole(5), await whole(10)];
  expect(lower).toBeGreaterThan(1000);
  expect(lower / all).toBeGreaterThan(0.25);
  expect(lower / all).toBeLessThan(0.5);
  // A hollow is no surface.
  await page.evaluate(() => window.harness.set({ places: [{ at_mm: [0, 0, 0], bounds_mm: [[-5, -5, 0], [5, 5, 10]], isHollow: true }] }));
  const hollow = await painted();
  expect(hollow[0] + hollow[1]).toBeLessThan(0.1 * all);
  // Two copies, of which the left one is selected and the right one marked.
  await page.evaluate(async () => {
    const { harness } = window;
    const shape = { positions: harness.solids.box([-5, -5, 0], [5, 5, 10]), rotation: [0, 0, 0, 1] as const, scale: 1 };
    const copies = [-10, 10].map((x_mm, place) => ({ place, shape, x_mm, y_mm: 0, turn_deg: 0, isColliding: false, supports: null }));
    await harness.set({ copies, selected: 0, aligned: true, places: [{ at_mm: [10, 0, 0], bounds_mm: [[5, -5, 0], [15, 5, 10]] }] });
  });
  const [left, right] = await painted();
  expect(left).toBe(0);
  expect(right).toBeGreaterThan(500);
});

test("a click lays a face flat", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({
      positions: harness.solids.box([0, 0, 0], [10, 20, 30]),
      // The side whose length is 10 leans towards the viewer.
      rotation: [0, Math.sin(0.2), 0, Math.cos(0.2)],
      tool: "flat",
    });
  });
  await forget(page);
  const box = await page.locator("cusp-view").boundingBox();
  await page.mouse.click((box?.x ?? 0) + (box?.width ?? 0) * 0.55, (box?.y ?? 0) + (box?.height ?? 0) * 0.5);
  await expect.poll(() => heard(page, "cusp-rotate")).toHaveLength(1);
  const [event] = await heard(page, "cusp-rotate");
  expect(event?.detail).toMatchObject({ final: true });
  // One of the sides lies on the plate, so the bounds are those of the box, in some order, to the last digit.
  const size = (await said(page)).match(/[\d.]+(?= ×| mm)/g)?.map(Number) ?? [];
  expect(size.toSorted((a, b) => a - b)).toEqual([10, 20, 30]);
});

test("the model is turned by its rings", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.ball(10, 32), tool: "rotate" });
    // A host that answers late, with an outdated rotation.
    harness.view.addEventListener("cusp-rotate", (event) => {
      if (!event.detail.final) harness.view.rotation = [0, 0, 0, 1];
    });
  });
  await forget(page);
  const box = await page.locator("cusp-view").boundingBox();
  const [x, y] = [(box?.x ?? 0) + (box?.width ?? 0) / 2, (box?.y ?? 0) + (box?.height ?? 0) / 2];
  // A line straight up from the middle crosses the ring about z somewhere.
  for (let away = 20; away < 220 && (await heard(page, "cusp-rotate")).length === 0; away += 5) {
    await page.mouse.move(x, y - away + 1);
    await page.mouse.move(x, y - away);
    await page.mouse.down();
    await page.mouse.move(x + 20, y - away, { steps: 4 });
    await page.mouse.move(x + 60, y - away, { steps: 4 });
    await page.mouse.up();
    await drawn(page);
  }
  const events = (await heard(page, "cusp-rotate")).map(({ detail }) => detail as { rotation: number[]; final: boolean });
  expect(events.length).toBeGreaterThan(1);
  expect(events.map(({ final }) => final)).toEqual([...events.slice(1).map(() => false), true]);
  expect(Math.hypot(...(events.at(-1)?.rotation ?? []))).toBeCloseTo(1, 6);
  expect(Math.abs(events.at(-1)?.rotation[3] ?? 1)).toBeLessThan(0.9999);
  expect(await page.evaluate(() => [...window.harness.view.rotation])).toEqual(events.at(-1)?.rotation);
});

test("the layer under the pointer is seen, and chosen with a click", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({
      positions: harness.solids.box([0, 0, 0], [20, 20, 20]),
      z_mm: [0, 5, 10, 15, 20],
      thickness_mm: [5, 5, 5, 5],
      limits: [5, 5],
      aligned: true,
      showsLegend: false,
    });
  });
  const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
  const box = await page.locator("cusp-view").boundingBox();
  const row = (z: number): number => frame.bottom_px + (z / 20) * (frame.top_px - frame.bottom_px);
  const [x, y] = [(box?.x ?? 0) + (box?.width ?? 0) / 2, box?.y ?? 0];
  await page.mouse.move(x, y + row(12));
  await expect.poll(async () => (await heard(page, "cusp-height")).at(-1)?.detail).toMatchObject({ layer: 2 });
  const last = (await heard(page, "cusp-height")).at(-1)?.detail as { z_mm: number } | undefined;
  expect(Math.abs((last?.z_mm ?? 0) - 12)).toBeLessThan(0.1);
  await page.mouse.click(x, y + row(7));
  await expect.poll(async () => (await heard(page, "cusp-layer")).at(-1)?.detail).toBe(1);
  await page.mouse.move(x, y - 10);
  await expect.poll(async () => (await heard(page, "cusp-height")).at(-1)?.detail).toEqual({ z_mm: null, layer: null });
  const before = await picture(page);
  await page.evaluate(() => window.harness.set({ layer: 1 }));
  const after = await picture(page);
  const middle = (box?.width ?? 0) / 2;
  expect(after(middle, row(7.5))).not.toEqual(before(middle, row(7.5)));
  expect(after(middle, row(17.5))).toEqual(before(middle, row(17.5)));
  expect(await said(page)).toContain("Layer 2");
});

test("by keyboard alone the view is turned, zoomed and used", async () => {
  const page = await start();
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({
      positions: harness.solids.box([0, 0, 0], [10, 20, 30]),
      z_mm: [0, 10, 30],
      thickness_mm: [10, 20],
      limits: [10, 20],
    });
  });
  await page.keyboard.press("Tab");
  const whole = await page.locator("canvas").screenshot();
  const press = async (...keys: string[]): Promise<Buffer> => {
    for (const key of keys) await page.keyboard.press(key);
    await drawn(page);
    return page.locator("canvas").screenshot();
  };
  const turned = await press("ArrowLeft", "ArrowUp");
  expect(turned.equals(whole)).toBe(false);
  const nearer = await press("+", "+");
  expect(nearer.equals(turned)).toBe(false);
  expect((await press("0")).equals(whole)).toBe(true);

  await page.evaluate(() => window.harness.set({ tool: "rotate" }));
  await forget(page);
  await press("ArrowRight", "Shift+PageUp");
  expect(await heard(page, "cusp-rotate")).toHaveLength(2);
  await page.evaluate(() => window.harness.set({ tool: "flat" }));
  await forget(page);
  await press("Enter");
  await expect.poll(() => heard(page, "cusp-rotate")).toHaveLength(1);
  expect(await said(page)).toMatch(/ mm, 2 layers$/);
});

/** Scrolls back to the top. Scrolling continues briefly after a wheel or touch gesture. */
async function atTop(page: Page): Promise<void> {
  const moved = (): Promise<number> =>
    page.evaluate(async () => {
      scrollTo(0, 0);
      await window.harness.drawn();
      await window.harness.drawn();
      return scrollY;
    });
  await expect.poll(moved).toBe(0);
}

test("the wheel scrolls the page past the view, and zooms once the view is chosen", async () => {
  const page = await start({ viewport: { width: 432, height: 300 } });
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.box([0, 0, 0], [10, 20, 30]) });
  });
  await page.mouse.move(200, 220);
  const before = await page.locator("canvas").screenshot();
  await page.mouse.wheel(0, 60);
  await expect.poll(() => page.evaluate(() => scrollY)).toBeGreaterThan(0);
  await atTop(page);
  expect((await page.locator("canvas").screenshot()).equals(before)).toBe(true);
  await page.mouse.click(200, 100);
  const scrolled = await page.evaluate(() => scrollY);
  await page.mouse.wheel(0, -120);
  await drawn(page);
  expect(await page.evaluate(() => scrollY)).toBe(scrolled);
  expect((await page.locator("canvas").screenshot()).equals(before)).toBe(false);
});

test("fingers turn, zoom and move the view, and one that goes upwards scrolls the page", async () => {
  const page = await start({ hasTouch: true, viewport: { width: 390, height: 400 } });
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    await harness.set({ positions: harness.solids.box([0, 0, 0], [10, 20, 30]) });
  });
  const session = await page.context().newCDPSession(page);
  type Finger = readonly [x: number, y: number];
  const touch = async (type: "touchStart" | "touchMove" | "touchEnd", ...fingers: Finger[]): Promise<void> => {
    const touchPoints = fingers.map(([x, y], id) => ({ x, y, id }));
    await session.send("Input.dispatchTouchEvent", { type, touchPoints });
  };
  const gesture = async (...stages: Finger[][]): Promise<void> => {
    const [first = [], ...rest] = stages;
    await touch("touchStart", ...first);
    for (const fingers of rest) await touch("touchMove", ...fingers);
    await touch("touchEnd");
    await drawn(page);
  };
  const shown = (): Promise<Buffer> => page.locator("canvas").screenshot();
  const before = await shown();
  await gesture([[100, 200]], [[120, 201]], [[160, 202]], [[220, 202]]);
  const turned = await shown();
  expect(turned.equals(before)).toBe(false);
  await gesture(
    [[150, 200], [240, 200]],
    [[130, 200], [260, 200]],
    [[100, 200], [290, 200]],
  );
  const nearer = await shown();
  expect(nearer.equals(turned)).toBe(false);
  expect(await page.evaluate(() => visualViewport?.scale)).toBe(1);
  await page.evaluate(() => scrollTo(0, 0));
  await gesture([[200, 300]], [[200, 280]], [[200, 230]], [[200, 180]]);
  await expect.poll(() => page.evaluate(() => scrollY)).toBeGreaterThan(20);
});

interface Wanted {
  locale?: string;
  hasPlot?: boolean;
  style?: Record<string, string>;
  /** Corners around the model; from 316 on, it counts as large. */
  around?: number;
  layer_mm?: number;
}

/** A window with room for a plot next to the view. */
const WIDE = { viewport: { width: 640, height: 640 } };
/** A panel that is quick to draw in software. */
const SMALL = { hasPlot: true, style: { width: "480px" } };

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

test("a finger selects a copy, and one that is held adds it", async () => {
  const page = await start({ hasTouch: true });
  await page.evaluate(async () => {
    const { harness } = window;
    harness.show();
    const shape = { positions: harness.solids.box([-5, -5, 0], [5, 5, 10]), rotation: [0, 0, 0, 1] as const, scale: 1 };
    const copies = [-10, 10].map((x_mm, place) => ({ place, shape, x_mm, y_mm: 0, turn_deg: 0, isColliding: false, supports: null }));
    await harness.set({ positions: shape.positions, copies, selected: 0, chosen: [0], aligned: true });
  });
  const session = await page.context().newCDPSession(page);
  const press = async (held_ms: number): Promise<void> => {
    const box = await page.locator("canvas").boundingBox();
    if (box === null) throw new Error("there is no view");
    const touchPoints = [{ x: box.x + 0.8 * box.width, y: box.y + 0.8 * box.height }];
    await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints });
    await page.waitForTimeout(held_ms);
    await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  };
  const details = async (): Promise<unknown[]> => (await heard(page, "cusp-select")).map(({ detail }) => detail);
  await press(0);
  await expect.poll(details).toEqual([{ place: 1, isMore: false }]);
  await press(700);
  await expect.poll(details).toEqual([{ place: 1, isMore: false }, { place: 1, isMore: true }]);
});

test("a finger turns the view freely where the host says that the page does not scroll", async () => {
  const page = await start({ hasTouch: true, viewport: { width: 390, height: 400 } });
  await show(page);
  await page.evaluate(() => document.documentElement.style.setProperty("--cusp-view-touch", "none"));
  const canvas = page.locator("cusp-view canvas");
  const before = await canvas.screenshot();
  await page.evaluate(() => scrollTo(0, 0));
  const session = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", ...ys: number[]): Promise<unknown> =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: ys.map((y) => ({ x: 150, y })) });
  await touch("touchStart", 300);
  for (const y of [280, 240, 200]) await touch("touchMove", y);
  await touch("touchEnd");
  await drawn(page);
  expect(await page.evaluate(() => scrollY)).toBe(0);
  expect((await canvas.screenshot()).equals(before)).toBe(false);
});

test("where there is no WebGL a sentence says so, and the tools are disabled with the reason", async () => {
  const page = await start({ before: withoutGl });
  await show(page).catch(() => undefined);
  const controls = page.locator("cusp-model .bar input");
  await expect.poll(() => controls.evaluateAll((all) => all.every((it) => (it as HTMLInputElement).disabled))).toBe(true);
  expect(await controls.count()).toBe(8);
  const reason = page.getByText("These tools need the 3-D view, which is not available.");
  expect(await reason.isVisible()).toBe(true);
  const id = await reason.getAttribute("id");
  expect(await controls.evaluateAll((all) => all.map((it) => it.getAttribute("aria-describedby")))).toEqual(Array(8).fill(id));
  await page.getByText("WebGL 2 is switched off or missing").waitFor();
  expect(await broken(page)).toEqual([]);
});

test("the bar has modes, of which one is on, and switches, by keyboard too; the printed look leaves the chart's side, and comes back", async () => {
  const page = await start(WIDE);
  await show(page, SMALL);
  const tool = (): Promise<string | undefined> => page.evaluate(() => window.harness.inner?.tool);
  await page.getByRole("radio", { name: "Look" }).focus();
  await page.keyboard.press("ArrowRight");
  expect(await tool()).toBe("rotate");
  await page.keyboard.press("ArrowRight");
  expect(await tool()).toBe("size");
  expect(await page.getByRole("radio", { checked: true }).count()).toBe(1);
  // One tab stop for all modes, one for the list of switches, and in it one for each.
  const list = page.locator("cusp-model summary");
  for (let i = 0; !(await list.evaluate((it) => it === (it.getRootNode() as ShadowRoot).activeElement)); i++) {
    expect(i).toBeLessThan(8);
    await page.keyboard.press("Tab");
  }
  await page.keyboard.press("Enter");
  await page.keyboard.press("Tab");
  for (const name of ["Beside the profile", "Cut at the layer", "As printed", "Distance from the model"]) {
    const it = page.getByRole("switch", { name });
    expect(await it.evaluate((it) => it === (it.getRootNode() as ShadowRoot).activeElement), name).toBe(true);
    const before = await it.isChecked();
    await page.keyboard.press("Space");
    expect(await it.isChecked(), name).toBe(!before);
    await page.keyboard.press("Tab");
  }
  expect(await broken(page)).toEqual([]);

  await show(page, SMALL);
  const [printed, measured, aligned] = ["As printed", "Distance from the model", "Beside the profile"].map((name) =>
    page.getByRole("switch", { name }),
  ) as [ReturnType<Page["getByRole"]>, ReturnType<Page["getByRole"]>, ReturnType<Page["getByRole"]>];
  const states = async (): Promise<boolean[]> => Promise.all([printed, measured, aligned].map((it) => it.isChecked()));
  await list.click();
  // Leaves the distances, which the keys have switched on.
  await aligned.click();
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
  await page.getByRole("radio", { name: "Paint" }).click();
  await list.click();
  expect(await states()).toEqual([false, false, false]);
  await aligned.click();
  expect(await states()).toEqual([false, false, true]);
  expect(await page.getByRole("radio", { name: "Look" }).isChecked()).toBe(true);
});

test("the bar is one line from 480 pixels on, and nothing is cut at 260, in all languages", async () => {
  const page = await start({ viewport: { width: 2000, height: 500 } });
  for (const locale of LANGUAGES) {
    await show(page, { locale, hasPlot: true });
    await page.evaluate(() => (window.harness.panel.rotation = [1, 0, 0, 0]));
    await page.locator("cusp-model summary").click();
    // The width at which labels appear is the tightest, with the labels of all but the tools for drains and plates.
    for (const width of [260, 400, 560]) {
      const found = await page.evaluate(async (width) => {
        const { panel, drawn } = window.harness;
        const frame = document.querySelector<HTMLElement>(".frame");
        const bar = panel.shadowRoot?.querySelector<HTMLElement>(".bar");
        if (!bar || !frame) throw new Error("there is no bar");
        // The neighbouring chart takes 8 rem.
        frame.style.width = `${width + 128}px`;
        await drawn();
        const targets = [...bar.querySelectorAll<HTMLElement>("label, button, summary")].map((it) => it.getBoundingClientRect());
        const { left, right } = bar.getBoundingClientRect();
        return {
          width: right - left,
          switches: bar.querySelectorAll(".switch").length,
          height: bar.offsetHeight,
          isInside: targets.every((it) => it.left >= left && it.right <= right),
          least: Math.min(...targets.flatMap((it) => [it.width, it.height])),
        };
      }, width);
      const at = `${locale} at ${width}`;
      expect(found, at).toMatchObject({ width, switches: 4, isInside: true });
      expect(found.least, at).toBeGreaterThanOrEqual(36);
      expect(found.height, at).toBeLessThanOrEqual(width === 260 ? 80 : 46);
    }
  }
});

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

test("with the brush the model stays visible in a box 650 high, and all tools can be reached", async () => {
  const page = await start({ viewport: { width: 800, height: 700 } });
  for (const width of [650, 260]) {
    await show(page, { style: { width: `${width}px`, height: "650px" } });
    const plain = await heights(page);
    expect(plain.panel).toBe(650);
    expect(plain.view).toBeGreaterThan(540);
    await page.getByRole("radio", { name: "Paint" }).click();
    await page.getByText("Load weights").waitFor();
    await drawn(page);
    const { view, width: across, tools, lowest } = await heights(page);
    expect(view).toBeGreaterThanOrEqual(350);
    expect(across).toBeGreaterThan(width === 650 ? 350 : width - 1);
    expect(tools).toBeGreaterThan(140);
    expect(lowest).toBeLessThanOrEqual(650);
    // All tools are reachable.
    await page.getByText("Load weights").scrollIntoViewIfNeeded();
    expect(await page.getByText("Load weights").isVisible()).toBe(true);
    await page.getByRole("radio", { name: "Look" }).click();
  }
});

test("forced colours show what is on, the scale and its mark, and draw the plate in the system's ink", async () => {
  const page = await start({ before: () => undefined });
  await page.emulateMedia({ forcedColors: "active" });
  await show(page, { style: { width: "360px" } });
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
const printed = async (page: Page): Promise<void> => {
  const list = page.locator("cusp-model summary");
  await list.click();
  await page.getByRole("switch", { name: "As printed" }).click();
  // It lies over the canvas.
  await list.click();
};

test("for the printed look the view comes so near that steps can be told apart, and goes back to the chart's side", async () => {
  const page = await start({ ...WIDE, deviceScaleFactor: 1 });
  await show(page, { layer_mm: 0.05, around: 256, hasPlot: true });
  // Marks the layer under the pointer.
  await page.mouse.move(0, 0);
  await ready(page);
  const before = await canvas(page);
  await printed(page);
  await ready(page);
  // At this distance, a layer covers two pixels.
  const found = await treads(page);
  expect(found.length).toBeGreaterThan(8);
  for (const [i, row] of found.slice(1).entries()) expect(row - (found[i] ?? 0)).toBeGreaterThanOrEqual(6);
  await printed(page);
  await page.mouse.move(0, 0);
  await drawn(page);
  await expect.poll(async () => (await canvas(page)).equals(before)).toBe(true);
});

/** Faults in each frame painted by the browser. */
interface Noted {
  readonly wrong: string[];
  frames: number;
}

/** Tracks canvases cleared by a new size and not drawn since, in `window.cleared`. */
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

/** Changes the layout by one step per frame, and checks each frame after it was painted. */
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
    panel.shadowRoot?.querySelector<HTMLInputElement>("[role=switch]")?.click();
    await harness.drawn();
    const look = (step: string): void => {
      noted.frames++;
      const [view, chart, picture] = [inner, plot, canvas].map((it) => it.getBoundingClientRect()) as [DOMRect, DOMRect, DOMRect];
      const isBeside = chart.height > 0 && chart.top >= view.top - 1 && chart.bottom <= view.bottom + 1;
      if (cleared.has(canvas)) noted.wrong.push(`${step}: empty`);
      const [wide, high] = [canvas.width / picture.width, canvas.height / picture.height];
      if (Math.abs(wide - high) > 0.01 || Math.abs(wide - devicePixelRatio) > 0.01) noted.wrong.push(`${step}: stretched`);
      // The picture of a large model comes later; it may be outdated, but not wrong.
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

test("while the layout changes no frame is empty, stretched, in the wrong projection or beside the heights of the plot, nor does resizing loop", async () => {
  const page = await start({ before: watchClearing, viewport: { width: 900, height: 800 } });
  await page.evaluate(() => {
    const said: string[] = [];
    Object.assign(window, { said });
    window.addEventListener("error", ({ message }) => said.push(`${innerWidth}: ${message}`));
  });
  await show(page, { hasPlot: true, style: { width: "650px", height: "500px" } });
  const { wrong, frames } = await through(page);
  expect(frames).toBeGreaterThan(40);
  expect(wrong).toEqual([]);

  await show(page, { hasPlot: true, around: 320, style: { width: "650px", height: "500px" } });
  // Until the first picture is there.
  await page.waitForFunction(() => {
    const canvas = window.harness.inner?.shadowRoot?.querySelector("canvas");
    return canvas != null && !(window as unknown as { cleared: WeakSet<object> }).cleared.has(canvas);
  });
  expect((await through(page, true)).wrong).toEqual([]);

  await show(page, { hasPlot: true, locale: "de" });
  // At 450 the plot moves from below the view to its side.
  for (let width = 435; width <= 465; width++) {
    await page.setViewportSize({ width, height: 640 });
    await drawn(page);
  }
  expect(await page.evaluate(() => (window as unknown as { said: string[] }).said)).toEqual([]);
});
