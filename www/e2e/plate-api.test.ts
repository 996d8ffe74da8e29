/** The headless plate in a real browser, from the package as it is published. */
import { unzipSync } from "fflate";
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from "vitest";
import { launch } from "./browser.js";
import { serveApi } from "./packed.js";
import type { Served } from "./serve.js";
import { prism, sphere } from "./solids.js";
import { Tabs } from "./tabs.js";

const ball = sphere(5, 48).bytes;
const block = prism(8, 6).bytes;

let served: Served;
let browser: Browser;
let page: Page;
const tabs = new Tabs();
const complaints: string[] = [];

beforeAll(async () => {
  served = await serveApi({ "ball.stl": ball, "block.stl": block });
  browser = await launch();
}, 120_000);

afterAll(async () => {
  await browser.close();
  await served.close();
});

beforeEach(async () => {
  page = await tabs.take(browser, {});
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.goto(served.address);
  await page.waitForFunction(() => "api" in window);
});

afterEach(async ({ task }) => {
  await tabs.giveBack(task.result?.state === "fail");
  expect(complaints.splice(0)).toEqual([]);
});

test("two models in several copies become one print file, and the masks show each copy", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const { plate } = slicer;
    const options = { pixels: [1000, 800] as [number, number], pitch_mm: 0.05, format: "png" as const };
    const block = await slicer.add("block.stl", { copies: 3 });
    const ball = await plate.add("ball.stl");
    const { plates, print_time_s, resin_ml } = await plate.plan(options);
    const lit = async (layer: number): Promise<number> => {
      const { bits } = await plate.mask(0, layer);
      return bits.reduce((sum, byte) => sum + byte.toString(2).replaceAll("0", "").length, 0);
    };
    const report = plates[0]?.report;
    if (report === undefined) throw new Error("no plate");
    const top = report.layers - 1;
    const both = [await lit(Math.floor(report.layers / 4)), await lit(top)];
    const file = await plate.export(0);
    const bytes = [...new Uint8Array(await file.blob.arrayBuffer())];
    await plate.remove(ball.id);
    await plate.update(block.id, { copies: 2 });
    const again = await plate.plan(options);
    const blocks = await lit(0);
    slicer.dispose();
    return { count: plates.length, report, print_time_s, resin_ml, both, name: file.name, bytes, again: again.plates[0]?.report.plate, blocks };
  });
  const { report } = found;
  expect(found.count).toBe(1);
  expect(report.plate?.models.map(({ copies }) => copies)).toEqual([3, 1]);
  expect(report.plate?.placements.map(({ model }) => model).toSorted()).toEqual([0, 0, 0, 1]);
  const [block, ball] = report.plate?.models ?? [];
  // A block of 8 × 8 × 6 mm, a ball of 10 mm, and what their copies share of the time.
  expect(block?.resin_ml).toBeCloseTo(0.384, 6);
  expect(3 * (block?.print_time_s ?? 0) + (ball?.print_time_s ?? 0)).toBeCloseTo(found.print_time_s, 6);
  expect(3 * (block?.resin_ml ?? 0) + (ball?.resin_ml ?? 0)).toBeCloseTo(found.resin_ml, 9);
  const [low = 0, high = 0] = found.both;
  const blocks = 3 * (8 / 0.05) ** 2;
  expect(low).toBeGreaterThan(blocks + 10_000);
  expect(high).toBeLessThan(blocks);
  expect(found.name).toBe("plate-1-cusp.zip");
  const images = Object.keys(unzipSync(Uint8Array.from(found.bytes))).filter((name) => name.endsWith(".png"));
  expect(images.length).toBeGreaterThanOrEqual(report.layers);
  expect(found.again?.models.map(({ copies }) => copies)).toEqual([2]);
  expect(found.blocks).toBe(2 * (8 / 0.05) ** 2);
});

test("a plan has the supports of each model, lifted, and the same as those of the model alone", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const options = { printer: "mars-4-ultra", supports: { strength: "light" as const } };
    await slicer.load("ball.stl");
    const alone = await slicer.plan(options);
    await slicer.add("ball.stl", { copies: 2 });
    await slicer.add("block.stl");
    const { supports, plates } = await slicer.plate.plan(options);
    const bare = await slicer.plate.plan({ printer: "mars-4-ultra" });
    slicer.dispose();
    const own = alone.supports ?? new Float32Array(0);
    const heights = supports?.map((positions) => positions.filter((_, i) => i % 3 === 2));
    return {
      lengths: supports?.map(({ length }) => length),
      isSame: own.length > 0 && own.every((mm, i) => mm === supports?.[0]?.[i]) && own.length === supports?.[0]?.length,
      lowest: heights?.map((z_mm) => z_mm.reduce((a, b) => Math.min(a, b))),
      lift_mm: plates[0]?.report.supported?.lift_mm,
      bare: "supports" in bare,
    };
  });
  expect(found).toMatchObject({ isSame: true, lowest: [0, 0], bare: false });
  expect(found.lift_mm).toBeGreaterThan(0);
  expect(found.lengths?.map((length) => length % 9)).toEqual([0, 0]);
});

test("a single copy gives the print file of the model alone, byte for byte", async () => {
  const isSame = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const options = { printer: "mars-4-ultra" };
    await slicer.load("ball.stl");
    const alone = await slicer.export(options);
    await slicer.add("ball.stl");
    await slicer.plate.plan(options);
    const plated = await slicer.plate.export(0);
    slicer.dispose();
    const [a, b] = await Promise.all([alone, plated].map(async ({ blob }) => new Uint8Array(await blob.arrayBuffer())));
    return [alone.name === plated.name, a !== undefined && a.length === b?.length && a.every((byte, i) => byte === b[i])];
  });
  expect(isSame).toEqual([true, true]);
});

test("cancelling a plan keeps the plate; copies that overlap are told", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const { plate } = slicer;
    const options = { printer: "mars-4-ultra" };
    await plate.add("block.stl", { copies: 40 });
    const arranged = await plate.arrange(options);
    // The second copy a millimetre beside the first.
    const overlapping = arranged.slice(0, 2).map((copy, i) => ({ ...copy, x_mm: (arranged[0]?.x_mm ?? 0) + i, y_mm: arranged[0]?.y_mm ?? 0 }));
    await plate.update(1, { copies: 2 });
    const problems = await plate.problems(options, overlapping);
    const refused = await plate.plan(options, { placements: overlapping }).then(
      () => "",
      (error: { code: string }) => error.code,
    );
    const abort = new AbortController();
    const cancelled = plate.plan(options, { signal: abort.signal, onProgress: () => abort.abort() }).then(
      () => "",
      (error: Error) => error.name,
    );
    const outcome = await cancelled;
    const { plates } = await plate.plan(options);
    slicer.dispose();
    return { problems, refused, outcome, copies: plates[0]?.report.plate?.models[0]?.copies };
  });
  expect(found.problems).toEqual([{ code: "plate-collision", detail: { model_numbers: [1, 1], copy_numbers: [1, 2], plate_number: 1 } }]);
  expect(found).toMatchObject({ refused: "plate-collision", outcome: "AbortError", copies: 2 });
});
