/** What the view draws, in a real browser. */
import { describe, expect, it } from "vitest";
import { colourAt } from "../src/view/legend/palette.js";
import { drawn, heard, likeness, picture, viewPages, type Pixel } from "./view-pages.js";

const start = viewPages();

/** Colours count as the same from this likeness on. */
const SAME = 0.995;

describe("the colours", () => {
  it.each(["classic", "safe"] as const)("of a cone in two layers are those of the palette %s, each at its height", async (palette) => {
    const page = await start();
    await page.evaluate(async (name) => {
      const { harness } = window;
      harness.show();
      await harness.set({
        positions: harness.solids.cone(10, 20, 64),
        z_mm: [0, 12, 20],
        thickness_mm: [12, 8],
        limits: [8, 12],
        palette: name,
        aligned: true,
        showsLegend: false,
      });
    }, palette);
    const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
    const at = await picture(page);
    const row = (z: number): number => frame.bottom_px + (z / 20) * (frame.top_px - frame.bottom_px);
    const middle = ((await page.locator("cusp-view").boundingBox())?.width ?? 0) / 2;
    const [thin, thick] = [colourAt(palette, 0), colourAt(palette, 1)];
    for (const z of [1, 6, 11.7]) expect(likeness(at(middle, row(z)), thick), `at ${z} mm`).toBeGreaterThan(SAME);
    for (const z of [12.3, 15, 18]) expect(likeness(at(middle, row(z)), thin), `at ${z} mm`).toBeGreaterThan(SAME);
    expect(likeness(thin, thick)).toBeLessThan(SAME);
    // Beside the cone, where it has grown narrow, there is nothing.
    expect(at(middle + 200, row(19))).toEqual(at(middle - 200, row(19)));
    expect(likeness(at(middle + 200, row(19)), thin)).toBeLessThan(SAME);
  });

  it("are exact to a layer among 2,000", async () => {
    const page = await start();
    const thickness = (layer: number): number => (layer % 3 === 0 ? 0.03 : 0.05);
    const z_mm = [0];
    for (let layer = 0; layer < 2000; layer++) z_mm.push((z_mm[layer] ?? 0) + thickness(layer));
    const height = z_mm.at(-1) ?? 0;
    await page.evaluate(
      async ([boundaries, top]) => {
        const { harness } = window;
        harness.show();
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
    for (const first of [0, 997, 1022, 1990]) {
      const [bottom, top] = [z_mm[first] ?? 0, z_mm[first + 10] ?? 0];
      await page.evaluate((heights_mm) => window.harness.set({ heights_mm }), [bottom, top] as const);
      const at = await picture(page);
      const box = await page.locator("cusp-view").boundingBox();
      for (let layer = first; layer < first + 10; layer++) {
        const middle = ((z_mm[layer] ?? 0) + (z_mm[layer + 1] ?? 0)) / 2;
        const row = (1 - (middle - bottom) / (top - bottom)) * (box?.height ?? 0);
        const wanted = colourAt("classic", layer % 3 === 0 ? 0 : 1);
        expect(likeness(at((box?.width ?? 0) / 2, row), wanted), `layer ${layer}`).toBeGreaterThan(SAME);
      }
    }
  });
});

describe("copies", () => {
  it("have their supports where they stand, turned with them", async () => {
    const page = await start();
    const shown = async (isSupported: boolean): Promise<(x_mm: number, z_mm: number) => Pixel> => {
      await page.evaluate(async (isSupported) => {
        const { harness } = window;
        const positions = harness.solids.box([-2, -2, 0], [2, 2, 8]);
        const supports = isSupported ? harness.solids.box([3, -1, 0], [5, 1, 12]) : null;
        const shape = { positions, rotation: [0, 0, 0, 1], scale: 1 } as const;
        const copies = [-9, 9].map((x_mm, place) => ({ place, shape, x_mm, y_mm: 0, turn_deg: 180 * place, isCrowded: false, supports }));
        harness.show();
        // The selected copy is the model.
        await harness.set({ positions, supports, copies, selected: 0, lift_mm: 4, aligned: true, heights_mm: [0, 40], showsLegend: false, inset: { top_px: 0, bottom_px: 0 } });
      }, isSupported);
      const at = await picture(page);
      const box = await page.locator("cusp-view").boundingBox();
      const scale = (box?.height ?? 0) / 40;
      return (x_mm, z_mm) => at((box?.width ?? 0) / 2 + scale * x_mm, scale * (40 - z_mm));
    };
    const places = [[-5, 1], [5, 1], [-5, 11], [5, 11]] as const;
    const without = await shown(false);
    const at = await shown(true);
    const [first, ...others] = places.map(([x, z]) => at(x, z));
    expect(first).not.toEqual(without(...places[0]));
    for (const pixel of others) expect(pixel).toEqual(first);
    for (const [x, z] of [[-13, 1], [13, 1], [-5, 13], [5, 13]] as const) expect(at(x, z), `${x}, ${z}`).toEqual(without(x, z));
  });
});

describe("drawing", () => {
  /** Counts what is sent to the GPU. */
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

  it("happens when something has changed, and a new plan sends no geometry", async () => {
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
    await page.waitForTimeout(300);
    expect((await counts())["drawArrays"]).toBeGreaterThan(0);
    await page.waitForTimeout(500);
    expect(Object.values(await counts()).filter((count) => count > 0)).toEqual([]);
    await page.evaluate(() => window.harness.set({ z_mm: [0, 8, 16, 20], thickness_mm: [8, 8, 4], limits: [4, 8] }));
    const after = await counts();
    expect(after["drawArrays"]).toBeGreaterThan(0);
    expect((after["texSubImage2D"] ?? 0) + (after["texImage2D"] ?? 0)).toBe(1);
    expect((after["bufferData"] ?? 0) + (after["bufferSubData"] ?? 0)).toBe(0);
  });

  it("goes on after the GPU has been lost and found", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32), z_mm: [0, 12, 20], thickness_mm: [12, 8], limits: [8, 12] });
    });
    const before = await picture(page);
    const [x, y] = [304, 330];
    await page.evaluate(async () => {
      const canvas = window.harness.view.shadowRoot?.querySelector("canvas");
      const lose = canvas?.getContext("webgl2")?.getExtension("WEBGL_lose_context");
      const happened = (type: string): Promise<unknown> =>
        new Promise((resolve) => canvas?.addEventListener(type, resolve, { once: true }));
      const lost = happened("webglcontextlost");
      lose?.loseContext();
      await lost;
      const restored = happened("webglcontextrestored");
      setTimeout(() => lose?.restoreContext());
      await restored;
      await window.harness.drawn();
    });
    expect((await picture(page))(x, y)).toEqual(before(x, y));
  });

  it("leaves nothing behind when the view goes, and begins anew when it comes back", async () => {
    const page = await start();
    const warnings: string[] = [];
    page.on("console", (message) => {
      if (/context/i.test(message.text())) warnings.push(message.text());
    });
    const alive = await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32), z_mm: [0, 20], thickness_mm: [20], limits: [8, 20] });
      const lost: boolean[] = [];
      // More contexts than a browser keeps at a time.
      for (let i = 0; i < 20; i++) {
        const context = harness.view.shadowRoot?.querySelector("canvas")?.getContext("webgl2");
        harness.view.remove();
        lost.push(context?.isContextLost() ?? false);
        harness.show();
        await harness.drawn();
      }
      return lost.filter((gone) => !gone).length;
    });
    expect(alive).toBe(0);
    expect(warnings.filter((text) => /too many/i.test(text))).toEqual([]);
    const at = await picture(page);
    expect(likeness(at(304, 330), colourAt("classic", 1))).toBeGreaterThan(SAME);
  });

  it("holds no more on the GPU after ten models than after two", async () => {
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
            await harness.set({ tool: "turn", palette: i % 2 === 0 ? "safe" : "classic" });
          }
          return (window as unknown as { live: { count: number } }).live.count;
        },
        [models, from] as const,
      );
    await page.evaluate(() => window.harness.show());
    const few = await after(2, 0);
    expect(few).toBeGreaterThan(5);
    // One or two come and go with what is being drawn; if models leaked, eight of them would remain.
    expect(Math.abs((await after(8, 2)) - few)).toBeLessThanOrEqual(2);
  });

  it("shows the whole model at any size until somebody moves it", async () => {
    const page = await start({ viewport: { width: 644, height: 640 } });
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32), showsLegend: false });
    });
    /** Whether the model reaches the edge of the view. */
    const isCut = async (): Promise<boolean> => {
      const { width = 0, height = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
      const at = await picture(page);
      // The model is much darker than what is behind it.
      return at(3, height / 2)[0] - at(width / 2, height / 2)[0] < 30;
    };
    await expect.poll(isCut).toBe(false);
    await page.setViewportSize({ width: 260, height: 640 });
    await expect.poll(isCut).toBe(false);
    await page.locator("cusp-view .scene").focus();
    for (let i = 0; i < 5; i++) await page.keyboard.press("+");
    await page.setViewportSize({ width: 240, height: 640 });
    await expect.poll(isCut).toBe(true);
  });

  it("follows the page's theme", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32) });
    });
    const light = (await picture(page))(304, 330);
    await page.emulateMedia({ colorScheme: "dark" });
    await expect.poll(async () => (await picture(page))(304, 330)[0]).toBeLessThan(light[0]);
  });

  it("is a sentence where there is no WebGL", async () => {
    const page = await start({
      before: () => {
        const before = HTMLCanvasElement.prototype.getContext as (...given: unknown[]) => unknown;
        Object.assign(HTMLCanvasElement.prototype, {
          getContext(this: HTMLCanvasElement, kind: string, ...given: unknown[]) {
            return kind === "webgl2" ? null : before.call(this, kind, ...given);
          },
        });
      },
    });
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({ positions: harness.solids.ball(10, 32), look: "printed", z_mm: [0, 20], thickness_mm: [20] });
    });
    expect(await page.locator("cusp-view .unavailable").innerText()).toMatch(/WebGL/);
    expect(await heard(page, "cusp-view-error")).toMatchObject([{ detail: { code: "no-webgl" } }]);
  });
});

describe("the printed look", () => {
  it("has vertical walls where the model slopes", async () => {
    const page = await start();
    await page.evaluate(async () => {
      const { harness } = window;
      harness.show();
      await harness.set({
        positions: harness.solids.cone(10, 20, 256),
        z_mm: [0, 10, 20],
        thickness_mm: [10, 10],
        limits: [5, 10],
        look: "printed",
        aligned: true,
        showsLegend: false,
      });
    });
    await page.waitForTimeout(300);
    await page.waitForFunction(() => window.harness.view.building === null);
    await drawn(page);
    const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
    const perMm = (frame.bottom_px - frame.top_px) / 20;
    const at = await picture(page);
    const { width = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
    /** Width of the model at a height, counted in pixels, mm. */
    const across = (z: number): number => {
      const row = frame.bottom_px - z * perMm;
      const [empty] = at(4, row);
      let count = 0;
      for (let x = 0; x < width; x++) if (Math.abs(at(x, row)[0] - empty) > 12) count++;
      return count / perMm;
    };
    // Sections at the middles of the layers: 7.5 mm and 2.5 mm of radius.
    for (const z of [0.5, 5, 9.5]) expect(Math.abs(across(z) - 15)).toBeLessThan(0.4);
    for (const z of [10.5, 15, 19.5]) expect(Math.abs(across(z) - 5)).toBeLessThan(0.4);
  });
});

describe("the distances", () => {
  it("are on the legend, from 0 to the largest, and in the colours of the steps", async () => {
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
    const done = async (): Promise<void> => {
      await page.waitForTimeout(300);
      await page.waitForFunction(() => window.harness.view.building === null && window.harness.view.measuring === null);
      await drawn(page);
    };
    await done();
    const plain = await picture(page);
    expect(await page.locator("cusp-view .legend").count()).toBe(0);
    await page.evaluate(() => window.harness.set({ look: "distance" }));
    await done();
    const ticks = await page.locator("cusp-view .ticks span").allInnerTexts();
    // Half a layer's thickness times |n_z|, in µm; the corners of the cone's base are 256.
    const largest = Number(ticks.at(-1)?.replace(",", ""));
    expect(ticks[0]).toBe("0");
    expect(Math.abs(largest - 2500 * Math.SQRT1_2)).toBeLessThan(2);
    const frame = (await heard(page, "cusp-frame")).at(-1)?.detail as { top_px: number; bottom_px: number };
    const { width = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
    const coloured = await picture(page);
    const row = (z: number): number => frame.bottom_px + (z / 10) * (frame.top_px - frame.bottom_px);
    const at = (z: number): [number, number] => [width / 2, row(z)];
    // A wall is on the cone half-way up, and farthest from it at its top.
    expect(likeness(coloured(...at(2.5)), colourAt("safe", 1))).toBeGreaterThan(0.98);
    expect(likeness(coloured(...at(4.9)), colourAt("safe", 0))).toBeGreaterThan(0.98);
    for (const z of [2.5, 4.9]) expect(likeness(coloured(...at(z)), plain(...at(z)))).toBeLessThan(0.98);
    // They stay with the steps: nothing is measured again.
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
});

it("stays quick with 100,000 facets", async () => {
  const page = await start({ viewport: { width: 1280, height: 720 } });
  const figures = await page.evaluate(async () => {
    const { harness } = window;
    const positions = harness.solids.ball(20, 318);
    const z_mm = Array.from({ length: 801 }, (_, i) => i * 0.05);
    const timed = async (what: () => Promise<unknown> | void): Promise<number> => {
      const before = performance.now();
      await what();
      return Math.round(10 * (performance.now() - before)) / 10;
    };
    harness.show();
    const out: Record<string, number> = { facets: positions.length / 9 };
    out["first_ms"] = await timed(() =>
      harness.set({ positions, z_mm, thickness_mm: z_mm.slice(1).map(() => 0.05), limits: [0.03, 0.1] }),
    );
    // The time that the main thread spends; the GPU does the drawing itself.
    const spent = async (properties: object): Promise<number> =>
      timed(async () => {
        Object.assign(harness.view, properties);
        await harness.view.updateComplete;
      });
    out["turn_ms"] = await spent({ rotation: [0.1, 0, 0, Math.sqrt(0.99)] });
    out["plan_ms"] = await spent({ z_mm: z_mm.map((z) => z) });
    await harness.drawn();
    const canvas = harness.view.shadowRoot?.querySelector("canvas");
    const { left = 0, top = 0, width = 0, height = 0 } = canvas?.getBoundingClientRect() ?? {};
    const [clientX, clientY] = [left + width / 2, top + height / 2];
    out["hover_ms"] = await timed(async () => {
      const seen = new Promise((resolve) => harness.view.addEventListener("cusp-height", resolve, { once: true }));
      canvas?.dispatchEvent(new PointerEvent("pointermove", { clientX, clientY, bubbles: true }));
      await seen;
    });
    const gaps: number[] = [];
    let last = performance.now();
    let building = true;
    const watch = (): void => {
      const now = performance.now();
      gaps.push(now - last);
      last = now;
      if (building) setTimeout(watch);
    };
    watch();
    out["steps_ms"] = await timed(async () => {
      harness.view.look = "printed";
      await harness.view.updateComplete;
      await new Promise((resolve) => setTimeout(resolve, 200));
      while (harness.view.building !== null) await new Promise((resolve) => setTimeout(resolve, 5));
    });
    out["distances_ms"] = await timed(async () => {
      harness.view.look = "distance";
      await harness.view.updateComplete;
      while (harness.view.measuring !== null) await new Promise((resolve) => setTimeout(resolve, 5));
    });
    building = false;
    out["longest_gap_ms"] = Math.round(Math.max(...gaps));
    return out;
  });
  console.log(`the view: ${JSON.stringify(figures)}`);
  expect(figures["facets"]).toBeGreaterThan(100_000);
  await expect.poll(() => page.evaluate(() => window.harness.view.building)).toBeNull();
});
