/** The headless slicer in a real browser, from the package as it is published. */
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from "vitest";
import type * as Api from "../src/api/index.js";
import { binaryStl, exampleTriangles } from "../src/page/example.js";
import { launch, SOFTWARE_GL } from "./browser.js";
import { serveApi } from "./packed.js";
import type { Served } from "./serve.js";
import { sphere } from "./solids.js";
import { Tabs } from "./tabs.js";

declare global {
  interface Window {
    api: typeof Api;
  }
}

const ball = sphere(10, 96).bytes;
const goblet = binaryStl(exampleTriangles());
// Enough facets and rays to observe each stage.
const heavy = sphere(10, 700).bytes;

let served: Served;
let browser: Browser;
let page: Page;
const tabs = new Tabs();
const complaints: string[] = [];

beforeAll(async () => {
  served = await serveApi({ "ball.stl": ball, "heavy.stl": heavy, "goblet.stl": goblet, "bad.stl": "no" });
  browser = await launch(SOFTWARE_GL);
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
  // One for each slicer, and two that helped the second.
  expect(page.workers()).toHaveLength(4);
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
  expect(found).toMatchObject({ schema: 2, names: ["ball.stl", "model.stl"], facets: (ball.length - 84) / 50, same: true, zip: "PK", points: 5 });
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
    return { none: none.length, length: stl.length, facets: info.facets, isClosed: info.closed, holes: report.hollowed?.drains.length };
  });
  expect(found.holes).toBeGreaterThan(0);
  expect(found.facets).toBeGreaterThan(0);
  expect(found).toMatchObject({ none: 84, length: 84 + 50 * found.facets, isClosed: true });
});

test("it works where there is no WebGPU, and says so", async () => {
  const backend = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    const { report } = await slicer.plan({ rays: 512, backend: "cpu" });
    slicer.dispose();
    return [report.backend, report.adapter];
  });
  expect(backend).toEqual(["cpu", null]);
});

test("a call that is not awaited takes its place: the plan is of the model that is being loaded", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    void slicer.load("goblet.stl");
    const [{ report }, { report: preview }, file] = await Promise.all([
      slicer.plan({ rays: 512, format: "uvj" }),
      slicer.preview({ rays: 512 }),
      slicer.export(),
    ]);
    slicer.dispose();
    const { name, type, warnings } = file;
    return { bytes: report.model.bytes, height_mm: preview.size_mm[2], file: { name, type }, isSame: warnings.length === report.warnings.length };
  });
  expect(found).toMatchObject({ bytes: goblet.byteLength, isSame: true });
  expect(found.height_mm).toBeGreaterThan(20.1);
  expect(found.file).toEqual({ name: "goblet-cusp.uvj", type: "application/octet-stream" });
});

test("looking at other plans leaves the print file alone, grey pixels and all", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    const bytes = async (): Promise<string> => {
      const { blob } = await slicer.export();
      return String(new Uint8Array(await crypto.subtle.digest("SHA-256", await blob.arrayBuffer())));
    };
    await slicer.load("ball.stl");
    await slicer.plan({ rays: 256, antialias: 4 });
    const before = await bytes();
    await slicer.tradeoff({});
    const traded = await bytes();
    await slicer.compare({ rays: 100, height_mm: 7 });
    const compared = await bytes();
    slicer.dispose();
    return { isSame: traded === before && compared === before };
  });
  expect(found).toEqual({ isSame: true });
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

test.each(["load", "ldi", "masks"] as const)("an abort during %s stops the call, and what was there before goes on", async (stage) => {
  const found = await page.evaluate(async (stage) => {
    const slicer = window.api.createSlicer();
    await slicer.load("heavy.stl");
    const options = { rays: 2048, backend: "cpu" } as const;
    const { report } = await slicer.plan(options);
    const abort = new AbortController();
    const call = {
      signal: abort.signal,
      onProgress: (at: string) => {
        if (at === stage) abort.abort();
      },
    };
    const running =
      stage === "load"
        ? slicer.load(await (await fetch("heavy.stl")).blob(), call)
        : stage === "ldi"
          ? slicer.plan({ ...options, rays: 4096 }, call)
          : slicer.export(options, call);
    const name = await running.then(
      () => "it ended",
      (error: Error) => error.name,
    );
    const mask = await slicer.mask(report.layers - 1);
    const again = await slicer.plan(options);
    slicer.dispose();
    return { name, isThere: mask.bits.length > 0, layers: [report.layers, again.report.layers] };
  }, stage);
  expect(found.name).toBe("AbortError");
  expect(found.isThere).toBe(true);
  expect(found.layers[0]).toBe(found.layers[1]);
});

test("what waits for its turn is aborted at once, and a stream that is cancelled leaves a working slicer", async () => {
  const found = await page.evaluate(async () => {
    const slicer = window.api.createSlicer();
    await slicer.load("ball.stl");
    const first = slicer.plan({ rays: 1024 });
    const second = await slicer.plan({ rays: 512 }, { signal: AbortSignal.abort() }).catch((error: Error) => error.name);
    const { report } = await first;
    const reader = slicer.exportStream().getReader();
    await reader.read();
    await reader.cancel();
    const { size } = (await slicer.export()).blob;
    slicer.dispose();
    const disposed = await slicer.plan().catch((error: Error) => error.name);
    return { second, layers: report.layers, size, disposed };
  });
  expect(found).toMatchObject({ second: "AbortError", disposed: "AbortError" });
  expect(found.size).toBeGreaterThan(1000);
});

test("a search for directions gives the same with any number of workers, and with what it measured before", async () => {
  const found = await page.evaluate(async () => {
    const search = { directions: 200, quality: "roughness" } as const;
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
    return Promise.all([1, 2, 3].map(searched));
  });
  const [one, ...others] = found;
  if (one === undefined) throw new Error("nothing was found");
  for (const other of others) expect(other).toEqual(one);
  expect(one.again).toEqual(one.best);
  expect(one.schema).toBe(2);
  expect(one.known).toBe(one.candidates.length);
  expect(one.candidates.length).toBeGreaterThanOrEqual(200);
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
