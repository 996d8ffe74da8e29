/** The view as a person uses it, by pointer and by keyboard, in a real browser. */
import { describe, expect, it } from "vitest";
import { broken } from "./axe.js";
import { drawn, forget, heard, picture, said, viewPages } from "./view-pages.js";

const start = viewPages();

describe("a person", () => {
  it("lays a face flat with a click", async () => {
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

  it("turns the model by its rings", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32), tool: "rotate" });
      // A host that answers late, with the earlier rotation.
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

  it("uses it by keyboard alone", async () => {
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

  it("sees the layer under the pointer and chooses it with a click", async () => {
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

  it("scrolls the page past the view, and zooms once the view is chosen", async () => {
    const page = await start({ viewport: { width: 640, height: 400 } });
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.box([0, 0, 0], [10, 20, 30]) });
    });
    await page.mouse.move(320, 300);
    const before = await page.locator("canvas").screenshot();
    await page.mouse.wheel(0, 60);
    await expect.poll(() => page.evaluate(() => scrollY)).toBeGreaterThan(0);
    // Scrolling continues for a moment.
    await page.waitForTimeout(400);
    await page.evaluate(() => scrollTo(0, 0));
    expect((await page.locator("canvas").screenshot()).equals(before)).toBe(true);
    await page.mouse.click(320, 100);
    const scrolled = await page.evaluate(() => scrollY);
    await page.mouse.wheel(0, -120);
    await drawn(page);
    expect(await page.evaluate(() => scrollY)).toBe(scrolled);
    expect((await page.locator("canvas").screenshot()).equals(before)).toBe(false);
  });

  it("turns and zooms with fingers, and scrolls the page with one that goes upwards", async () => {
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

  it("comes back from the chart's side to where it was", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.box([0, 0, 0], [10, 20, 30]) });
    });
    await page.keyboard.press("Tab");
    await page.keyboard.press("ArrowLeft");
    await drawn(page);
    const before = await page.locator("canvas").screenshot();
    expect(await heard(page, "cusp-frame")).toEqual([]);
    await page.evaluate(() => window.harness.set({ aligned: true, inset: { top_px: 20, bottom_px: 50 } }));
    const { height = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
    expect((await heard(page, "cusp-frame")).at(-1)?.detail).toEqual({ top_px: 20, bottom_px: height - 50 });
    // Turning about the vertical axis leaves heights where they are.
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowUp");
    await drawn(page);
    expect((await heard(page, "cusp-frame")).at(-1)?.detail).toEqual({ top_px: 20, bottom_px: height - 50 });
    await page.evaluate(() => window.harness.set({ heights_mm: [10, 20] }));
    const part = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
    const perMm = (height - 70) / 10;
    expect(part.top_px).toBeCloseTo(20 - 10 * perMm, 1);
    expect(part.bottom_px).toBeCloseTo(height - 50 + 10 * perMm, 1);
    await page.evaluate(() => window.harness.set({ aligned: false }));
    expect((await heard(page, "cusp-frame")).at(-1)?.detail).toBeNull();
    expect((await page.locator("canvas").screenshot()).equals(before)).toBe(true);
  });

  it("finds nothing that hinders", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({
        positions: harness.solids.ball(10, 32),
        z_mm: [0, 12, 20],
        thickness_mm: [12, 8],
        limits: [8, 12],
        layer: 1,
        plate: { width_mm: 15, depth_mm: 40, height_mm: 60 },
      });
    });
    expect(await broken(page)).toEqual([]);
  });
});
