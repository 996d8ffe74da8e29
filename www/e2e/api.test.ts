/** The headless slicer and its plate in a real browser, from the published package. */
import { unzipSync } from "fflate";
import type { Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from "vitest";
import type * as Api from "../src/api/index.js";
import { binaryStl, exampleTriangles } from "../src/page/example.js";
import { USUAL } from "./browser.js";
import { serveApi } from "./packed.js";
import type { Served } from "./serve.js";
import { prism, sphere } from "./solids.js";
import { tabs } from "./tabs.js";

declare global {
  interface Window {
    api: typeof Api;
  }
}

const ball = sphere(10, 48).bytes;
const block = prism(8, 6).bytes;
const goblet = binaryStl(exampleTriangles());
// Enough facets and rays to observe each stage.
const heavy = sphere(10, 400).bytes;

let served: Served;
let page: Page;
const own = tabs();
const complaints: string[] = [];

beforeAll(async () => {
  served = await serveApi({ "ball.stl": ball, "small.stl": sphere(5, 48).bytes, "block.stl": block, "heavy.stl": heavy, "goblet.stl": goblet, "bad.stl": "no" });
}, 120_000);

afterAll(() => served.close());

beforeEach(async () => {
  page = await own.take(USUAL);
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.goto(served.address);
  await page.waitForFunction(() => "api" in window);
});

afterEach(async ({ task }) => {
  await own.giveBack(task.result?.state === "fail");
  expect(complaints.splice(0)).toEqual([]);
});

test("a print file is the same however many workers encode its layers", async () => {
  const files = await page.evaluate(async () => {
    const files: { sum: string; fractions: number[] }[] = [];
    for (const workers of [1, 3]) {
      const slicer = window.api.createSlicer({ workers });
      await slicer.load("ball.stl");
      for (const format of ["chitubox", "nanodlp"] as const) {
        await slicer.plan({ rays: 512, format, planner: { kind: "finest" } });
        const fractions: number[] = [];
        const { blob } = await slicer.export(undefined, { onProgress: (stage, fraction) => void (stage === "masks" && fractions.push(fraction)) });
        const hash = await crypto.subtle.digest("SHA-256", await blob.arrayBuffer());
        files.push({ sum: new Uint8Array(hash).join(), fractions });
      }
    }
    return files;
  });
  const [one, other, shared, otherShared] = files.map(({ sum }) => sum);
  expect([shared, otherShared]).toEqual([one, other]);
  expect(one).not.toBe(other);
  for (const { fractions } of files) expect(fractions).toEqual([...fractions].sort((a, b) => a - b));
  // One per slicer, and two helpers of the second, which may arrive too late to help.
  await expect.poll(() => page.workers().length).toBe(4);
});

test("from a file to a print file: by address, bytes, Blob; whole and in chunks the same bytes", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const model = await slicer.load("ball.stl");
    const { schema, report, profile } = await slicer.plan({ rays: 512 });
    const mask = await slicer.mask(Math.floor(report.layers / 2));
    const curve = await slicer.tradeoff({ rays: 512 }, 5);
    const comparison = await slicer.compare({ rays: 512 });
    const whole = new Uint8Array(await (await slicer.export()).blob.arrayBuffer());
    const streamed = new Uint8Array(await new Response(slicer.exportStream()).arrayBuffer());
    const bytes = await (await fetch("ball.stl")).arrayBuffer();
    const again = await slicer.load(bytes);
    const plan = await slicer.plan({ rays: 512 });
    slicer.dispose();
    return {
      schema,
      names: [model.name, again.name],
      facets: model.info.facets,
      layers: [report.layers, plan.report.layers],
      backend: report.backend,
      bins: [report.bins, profile.length],
      mask: [mask.width, mask.height, mask.bits.length, mask.bits.some((byte) => byte !== 0)],
      points: curve.points.length,
      rows: comparison.rows.length,
      same: whole.length === streamed.length && whole.every((byte, i) => byte === streamed[i]),
      zip: String.fromCharCode(...whole.slice(0, 2)),
    };
  });
  expect(found).toMatchObject({ schema: 3, names: ["ball.stl", "model.stl"], facets: (ball.length - 84) / 50, same: true, zip: "PK", points: 5 });
  expect(found.layers[0]).toBe(found.layers[1]);
  expect(found.bins[0]).toBe(found.bins[1]);
  expect(["cpu", "gpu"]).toContain(found.backend);
  const [width = 0, height = 0, length, isLit] = found.mask as [number, number, number, boolean];
  expect([length, isLit]).toEqual([Math.ceil(width / 8) * height, true]);
  expect(found.rows).toBeGreaterThan(2);
});

test("plugs are an STL that can be read, and of no facets without holes", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    await slicer.plan({ rays: 512 });
    const none = await slicer.plugs();
    const { report } = await slicer.plan({ rays: 512, hollow: { wall_mm: 1.5, auto_drain: {} } });
    const stl = await slicer.plugs();
    const { info } = await slicer.load(stl, { name: "plugs.stl" });
    slicer.dispose();
    return { none: none.length, length: stl.length, facets: info.facets, isClosed: info.closed, holes: report.models[0]?.hollowed?.drains.length };
  });
  expect(found.holes).toBeGreaterThan(0);
  expect(found.facets).toBeGreaterThan(0);
  expect(found).toMatchObject({ none: 84, length: 84 + 50 * found.facets, isClosed: true });
});

test("errors have codes and details", async () => {
  const codes = await page.evaluate(async () => {
    const { createSlicer, SlicerError } = window.api;
    const slicer = createSlicer();
    const code = async (call: Promise<unknown>): Promise<unknown> => {
      try {
        await call;
        return "nothing was thrown";
      } catch (error) {
        if (!(error instanceof SlicerError)) return String(error);
        return error.detail === null ? error.code : [error.code, Object.keys(error.detail).sort()];
      }
    };
    const found = [
      await code(slicer.plan()),
      await code(slicer.load("bad.stl")),
      await code(slicer.load(new Blob(["glTF\u0002"]))),
      await code(slicer.load("nowhere.stl")),
      await code(slicer.load("ball.stl")),
      await code(slicer.mask(0)),
      await code(slicer.plan({ rays: 512, tolerance: 0.01 })),
      await code(slicer.plan({ rays: 512, printer: "nobody" })),
      await code(slicer.plan({ printer: { pixels: [100, 100], pitch_um: [50, 0], volume_mm: [5, 5, 5] } })),
      await code(slicer.plan({ printer: { pixels: [100, 100] } as unknown as Api.Printer })),
    ];
    slicer.dispose();
    return found;
  });
  expect(codes).toEqual([
    "no-model",
    "unknown-file-kind",
    ["other-file-kind", ["kind"]],
    ["fetch-failed", ["status"]],
    "nothing was thrown",
    "no-plan",
    ["infeasible", ["from_mm", "largest_layer_min_mm", "layer_min_mm", "least_tolerance", "model_number", "to_mm", "tolerance"]],
    ["unknown-printer", ["known", "printer", "similar"]],
    ["bad-printer", ["field", "printer"]],
    ["bad-options", ["system"]],
  ]);
});

test("an abort stops a call at any stage, at once if it waits for its turn, and what was there before goes on", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const nameOf = (running: Promise<unknown>): Promise<string> =>
      running.then(
        () => "it ended",
        (error: Error) => error.name,
      );
    await slicer.load("heavy.stl");
    const options = { rays: 512, backend: "cpu" } as const;
    const { report } = await slicer.plan(options);
    const names: string[] = [];
    const layers: number[] = [report.layers];
    for (const stage of ["load", "ldi", "masks"]) {
      const abort = new AbortController();
      const call = { signal: abort.signal, onProgress: (at: string) => void (at === stage && abort.abort()) };
      const file = await (await fetch("heavy.stl")).blob();
      const running = { load: () => slicer.load(file, call), ldi: () => slicer.plan({ ...options, rays: 2048 }, call), masks: () => slicer.export(options, call) };
      names.push(await nameOf(running[stage as keyof typeof running]()));
      const { bits } = await slicer.mask(report.layers >> 1);
      if (!bits.some((byte) => byte !== 0)) throw new Error(`no mask after ${stage}`);
      layers.push((await slicer.plan(options)).report.layers);
    }
    const first = slicer.plan({ rays: 512 });
    names.push(await nameOf(slicer.plan({ rays: 256 }, { signal: AbortSignal.abort() })));
    await first;
    const reader = slicer.exportStream().getReader();
    await reader.read();
    await reader.cancel();
    const { size } = (await slicer.export()).blob;
    slicer.dispose();
    names.push(await nameOf(slicer.plan()));
    return { names, layers: new Set(layers).size, size };
  });
  expect(found).toMatchObject({ names: Array.from({ length: 5 }, () => "AbortError"), layers: 1 });
  expect(found.size).toBeGreaterThan(1000);
});

test("a call whose worker ends without a word rejects, and the next one has another worker", async () => {
  await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    Object.assign(window, { slicer });
  });
  // The worker accepts the next call, and dies instead of answering.
  await page.workers()[0]?.evaluate(() => Object.assign(self, { postMessage: () => close() }));
  const [code, layers] = await page.evaluate(async () => {
    const { slicer } = window as unknown as { slicer: Api.Slicer };
    const code = await slicer.plan({ rays: 512 }).then(() => "a plan", (error: Api.SlicerError) => error.code);
    return [code, (await slicer.plan({ rays: 512 })).report.layers] as const;
  });
  expect(code).toBe("crash");
  expect(layers).toBeGreaterThan(100);
});

test("a search for directions gives the same with any number of workers, and with what it measured before", async () => {
  const found = await page.evaluate(async () => {
    const search = { directions: 50, quality: "roughness" } as const;
    const searched = async (workers: number) => {
      const slicer = window.api.createSlicer({ workers });
      await slicer.load("goblet.stl");
      let known = 0;
      const onCandidates: NonNullable<Api.OrientCall["onCandidates"]> = ({ candidates }) =>
        (known = candidates.filter((candidate) => candidate !== null).length);
      const { schema, candidates, best } = await slicer.orient({}, search, { onCandidates });
      const again = await slicer.orient({}, search, { measured: candidates });
      const [first] = best;
      const plan = await slicer.plan({ rays: 512, backend: "cpu", ...(first && { rotation: first.rotation }) });
      slicer.dispose();
      return { schema, known, candidates, best, again: again.best, layers: plan.report.layers };
    };
    return Promise.all([1, 2].map(searched));
  });
  const [one, ...others] = found;
  if (one === undefined) throw new Error("nothing was found");
  for (const other of others) expect(other).toEqual(one);
  expect(one.again).toEqual(one.best);
  expect(one.schema).toBe(3);
  expect(one.known).toBe(one.candidates.length);
  expect(one.candidates.length).toBeGreaterThanOrEqual(50);
  const [first] = one.best;
  expect(first?.energy).toBeLessThanOrEqual(Math.min(...one.candidates.map(({ energy }) => energy ?? Infinity)));
  expect(one.layers).toBe(first?.metrics?.layers);
});

test("a search is aborted, by its signal and with its slicer; what cannot be searched for has a code", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer({ workers: 2 });
    const nameOf = (running: Promise<unknown>): Promise<string> =>
      running.then(
        () => "it ended",
        (error: Error) => (error instanceof window.api.SlicerError ? error.code : error.name),
      );
    const before = await nameOf(slicer.orient());
    await slicer.load("heavy.stl");
    const abort = new AbortController();
    const aborted = nameOf(slicer.orient({}, {}, { signal: abort.signal, onCandidates: () => abort.abort() }));
    const names = [before, await aborted];
    const { best } = await slicer.orient({}, { directions: 20 });
    names.push(await nameOf(slicer.orient({}, { directions: 20, alpha: 2 })));
    names.push(await nameOf(slicer.orient({ printer: "nobody" }, { directions: 20 })));
    const left = nameOf(slicer.orient());
    slicer.dispose();
    names.push(await left);
    return { names, best: best.length };
  });
  expect(found.names).toEqual(["no-model", "AbortError", "bad-alpha", "unknown-printer", "AbortError"]);
  expect(found.best).toBeGreaterThan(0);
});

test("two models in several copies become one print file, and the masks show each copy", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const options = { pixels: [1000, 800] as [number, number], pitch_mm: 0.05, format: "png" as const };
    const block = await slicer.add("block.stl", { copies: 3 });
    const ball = await slicer.add("small.stl");
    const { plates, print_time_s, resin_ml } = await slicer.plan(options);
    const lit = async (layer: number): Promise<number> => {
      const { bits } = await slicer.mask(layer);
      return bits.reduce((sum, byte) => sum + byte.toString(2).replaceAll("0", "").length, 0);
    };
    const report = plates[0]?.report;
    if (report === undefined) throw new Error("no plate");
    const top = report.layers - 1;
    const both = [await lit(Math.floor(report.layers / 4)), await lit(top)];
    const file = await slicer.export();
    const bytes = [...new Uint8Array(await file.blob.arrayBuffer())];
    await slicer.remove(ball.id);
    await slicer.update(block.id, { copies: 2 });
    const again = await slicer.plan(options);
    const blocks = await lit(0);
    slicer.dispose();
    return { count: plates.length, report, print_time_s, resin_ml, both, name: file.name, bytes, again: again.plates[0]?.report, blocks };
  });
  const { report } = found;
  expect(found.count).toBe(1);
  expect(report.models.map(({ copies }) => copies)).toEqual([3, 1]);
  expect(report.placements.map(({ model }) => model).toSorted((a, b) => a - b)).toEqual([0, 0, 0, 1]);
  const [block, ball] = report.models;
  // A block of 8 × 8 × 6 mm, a ball of 10 mm, and their copies' shares of the time.
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

test("cancelling a plan keeps the models; copies that overlap are told", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const options = { printer: "mars-4-ultra" };
    const { id } = await slicer.add("block.stl", { copies: 40 });
    const arranged = await slicer.arrange(options);
    // The second copy one millimetre from the first.
    const overlapping = arranged.slice(0, 2).map((copy, i) => ({ ...copy, x_mm: (arranged[0]?.x_mm ?? 0) + i, y_mm: arranged[0]?.y_mm ?? 0 }));
    await slicer.update(id, { copies: 2 });
    const problems = await slicer.problems(options, overlapping);
    const refused = await slicer.plan(options, { placements: overlapping }).then(
      () => "",
      (error: { code: string }) => error.code,
    );
    const abort = new AbortController();
    const cancelled = slicer.plan(options, { signal: abort.signal, onProgress: () => abort.abort() }).then(
      () => "",
      (error: Error) => error.name,
    );
    const outcome = await cancelled;
    const { plates } = await slicer.plan(options);
    slicer.dispose();
    return { problems, refused, outcome, copies: plates[0]?.report.models[0]?.copies };
  });
  expect(found.problems).toEqual([{ code: "plate-collision", detail: { model_numbers: [1, 1], copy_numbers: [1, 2], plate_number: 1 } }]);
  expect(found).toMatchObject({ refused: "plate-collision", outcome: "AbortError", copies: 2 });
});
