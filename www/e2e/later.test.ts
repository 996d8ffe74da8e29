/** The slicer's later part: a plan and its print file do without it, and whatever needs it fetches it first. */
import type { Browser, Page } from "playwright-core";
import { afterAll, beforeAll, expect, test } from "vitest";
import type { CuspWorkbench } from "../src/workbench/cusp-workbench.js";
import { downloaded, drop, launch, openPanel, requests, settled, state, words } from "./browser.js";
import { serveApi } from "./packed.js";
import { pages } from "./pages.js";
import type { Served } from "./serve.js";
import { cup, sphere } from "./solids.js";

const start = pages();
const ball = { name: "ball.stl", bytes: sphere(10, 48).bytes };
const mug = { name: "mug.stl", bytes: cup(10, 8, 1.5) };

/** The requests for the part from now on. */
const fetches = (page: Page, isOffline?: () => boolean): Promise<string[]> => requests(page, /cusp_slicer_later[^/]*\.wasm$/, isOffline);

/** Gives the page other settings. */
const ask = (page: Page, query: string): Promise<void> =>
  page.locator("cusp-workbench").evaluate((element: CuspWorkbench, query) => void (element.query = query), query);

test("the page plans, draws and writes a print file without it, and fetches it once for checks and supports", async () => {
  const page = await start("?backend=cpu&rays=256");
  const fetched = await fetches(page);
  await drop(page, mug);
  await state(page, "done");
  await openPanel(page, "Mask");
  await page.waitForSelector("canvas[data-layer]");
  expect((await downloaded(page)).bytes.length).toBeGreaterThan(1000);
  expect(fetched).toEqual([]);

  await openPanel(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
  expect(fetched.length).toBe(1);
  await ask(page, "supports=medium");
  await settled(page);
  await page.waitForSelector("cusp-findings [data-verdict]");
  expect(fetched.length).toBe(1);
});

test("without it a check says so, and is made once it can be fetched", async () => {
  const page = await start("?backend=cpu&rays=256");
  let isOffline = true;
  await fetches(page, () => isOffline);
  await drop(page, mug);
  await state(page, "done");
  await openPanel(page, "Check");
  expect(await page.locator("cusp-findings .failed").innerText()).toContain("could not be loaded: slicer-later");
  isOffline = false;
  await openPanel(page, "Turn");
  await openPanel(page, "Check");
  await page.waitForSelector("cusp-findings [data-verdict]");
});

test("without it a plan with supports says so, one without is made, and so is that with supports later", async () => {
  const page = await start("?backend=cpu&rays=256&supports=light");
  let isOffline = true;
  await fetches(page, () => isOffline);
  await drop(page, ball);
  await state(page, "error");
  await expect.poll(() => words(page)).toContain("could not be loaded: slicer-later");
  await ask(page, "supports=none");
  await settled(page);
  isOffline = false;
  await ask(page, "supports=light");
  await settled(page);
});

let served: Served;
let browser: Browser;

beforeAll(async () => {
  served = await serveApi({ "ball.stl": ball.bytes });
  browser = await launch();
}, 120_000);

afterAll(async () => {
  await browser.close();
  await served.close();
});

/** Calls of a slicer that holds a plan of the ball, each the first that needs the part. */
const CALLS = ["check", "compare", "calibrateLayers", "orient", "measure", "weightsFile", "plugs", "plate", "supports", "hollow", "void's curve"] as const;

test("every call that needs it fetches it by itself", async () => {
  for (const call of CALLS) {
    const page = await browser.newPage();
    const fetched = await fetches(page);
    await page.goto(served.address);
    await page.waitForFunction(() => "api" in window);
    const before = await page.evaluate(async () => {
      const slicer = window.api.createSlicer({ workers: 1 });
      Object.assign(window, { slicer });
      const options = { rays: 128, backend: "cpu" } as const;
      await slicer.load("ball.stl");
      const { report } = await slicer.plan(options);
      await Promise.all([slicer.preview(options), slicer.tradeoff(options, 5), slicer.mask(0), slicer.export(), slicer.printers(), slicer.saliency()]);
      await slicer.price({ currency: "EUR", resin_per_ml: 1 });
      await slicer.setWeights(new Float32Array((await slicer.positions()).length / 9).fill(1));
      return report.layers;
    });
    expect(before, call).toBeGreaterThan(10);
    expect(fetched, `before ${call}`).toEqual([]);
    await page.evaluate(async (call) => {
      const { slicer } = window as unknown as { slicer: ReturnType<typeof window.api.createSlicer> };
      const options = { rays: 128, backend: "cpu" } as const;
      const screen = { pixels: [1000, 800] as [number, number], pitch_mm: 0.05 };
      const calls: Record<string, () => Promise<unknown>> = {
        check: () => slicer.check({}),
        compare: () => slicer.compare(options),
        calibrateLayers: () => slicer.calibrateLayers(screen),
        orient: () => slicer.orient(options, { directions: 20 }),
        measure: () => slicer.measure(options, [0, 0, 1]),
        weightsFile: async () => slicer.readWeights(await slicer.weightsFile(new Float32Array((await slicer.positions()).length / 9).fill(1))),
        plugs: () => slicer.plugs(),
        plate: async () => {
          await slicer.add("ball.stl");
          await slicer.plate.plan(screen);
        },
        supports: () => slicer.plan({ ...options, supports: {} }),
        hollow: () => slicer.plan({ ...options, hollow: { wall_mm: 1 } }),
        "void's curve": () => slicer.tradeoff({ ...options, hollow: { wall_mm: 1 } }, 5),
      };
      await calls[call]?.();
    }, call);
    expect(fetched.length, call).toBeGreaterThan(0);
    await page.close();
  }
});
