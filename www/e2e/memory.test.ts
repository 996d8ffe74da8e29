/** Ten models in a row leave as much in memory as two. */
import type { CDPSession, Page } from "playwright-core";
import { expect, test } from "vitest";
import { drop, openPanel, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";
import { SOFTWARE_GL } from "./view-pages.js";

const MODELS = 10;
/** After this many models, all that is made once exists: compiled code, workers, the view. */
const WARM = 2;

/** Points around each model: all models have equally many facets, and so need equally much memory. */
const AROUND = 256;
const FACETS = AROUND * (AROUND - 2);
/** The corners of a model's facets, nine numbers of four bytes each: the least that a leaked model would hold. */
const MODEL_BYTES = FACETS * 9 * 4;

/** Slack of the page, for what the browser's compiler and caches take meanwhile: less than two models. */
const HEAP_SLACK_BYTES = 2 * MODEL_BYTES;
/** Slack of a worker, whose memory never shrinks: it grows by pieces that do not fit where an earlier model was. */
const CORE_SLACK_BYTES = 2 * MODEL_BYTES;
/** A leaked model would hold some 600 nodes and 40 listeners. */
const NODE_SLACK = 200;
/** Ports that carried progress are freed only when the worker's own garbage collector runs. */
const LISTENER_SLACK = 100;

interface Usage {
  /** Of the page itself, bytes: objects, and the storage of their arrays. */
  heap: number;
  nodes: number;
  listeners: number;
  workers: number;
  /** WebGL contexts that are not lost. */
  contexts: number;
  /** WebAssembly memory of each worker, bytes. */
  core: number[];
}

declare global {
  interface Window {
    contexts: WeakRef<WebGL2RenderingContext>[];
    cores: WebAssembly.Memory[];
  }
}

/** Runs before the page's own scripts: records every context that is made. */
function watchContexts(): void {
  window.contexts = [];
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, ...asked: unknown[]) {
    const context = Reflect.apply(getContext, this, asked) as RenderingContext | null;
    const isKnown = window.contexts.some((it) => it.deref() === context);
    if (context instanceof WebGL2RenderingContext && !isKnown) window.contexts.push(new WeakRef(context));
    return context;
  } as typeof getContext;
}

/** Runs at the top of a worker's script: records the memory of what it instantiates. */
const WATCH_CORE = `self.cores = [];
for (const name of ["instantiate", "instantiateStreaming"]) {
  const before = WebAssembly[name];
  WebAssembly[name] = async (...asked) => {
    const made = await before(...asked);
    self.cores.push((made.instance ?? made).exports.memory);
    return made;
  };
}
`;

async function usage(page: Page, devtools: CDPSession): Promise<Usage> {
  // What a first collection frees may have kept more alive.
  for (let i = 0; i < 3; i++) await devtools.send("HeapProfiler.collectGarbage");
  const { usedSize, backingStorageSize } = await devtools.send("Runtime.getHeapUsage");
  const { metrics } = await devtools.send("Performance.getMetrics");
  const metric = (name: string): number => metrics.find((it) => it.name === name)?.value ?? NaN;
  const bytes = await Promise.all(
    page.workers().map((worker) => worker.evaluate(() => self.cores.reduce((sum, { buffer }) => sum + buffer.byteLength, 0))),
  );
  return {
    heap: usedSize + backingStorageSize,
    nodes: metric("Nodes"),
    listeners: metric("JSEventListeners"),
    workers: page.workers().length,
    contexts: await page.evaluate(
      () => window.contexts.filter((it) => it.deref()?.isContextLost() === false).length,
    ),
    core: bytes.sort((a, b) => a - b),
  };
}

const start = pages(SOFTWARE_GL);

test("ten models in a row leave the heap where it was", async () => {
  const page = await start("", {}, true);
  await page.addInitScript(watchContexts);
  await page.route(/worker-[^/]*\.js$/, async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, body: WATCH_CORE + (await answer.text()) });
  });
  await page.reload();
  await state(page, "empty");
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Performance.enable");

  const used: Usage[] = [];
  for (let i = 1; i <= MODELS; i++) {
    const name = `ball-${i}.stl`;
    // Each model is a little lower than the one before, so that the freed memory suffices: the test looks for leaks, not
    // for whether the holes that larger models leave happen to fit.
    const height_mm = 2 * (12 - 0.1 * i);
    await drop(page, { name, bytes: sphere(height_mm / 2, AROUND).bytes });
    // The previous model is on show until this one is read.
    await expect.poll(() => page.locator(".model-name").allInnerTexts()).toEqual([name]);
    await state(page, "done");
    // Not `waitForSelector`, whose result would keep the canvas alive.
    await openPanel(page, "Mask");
    await page.locator("canvas[data-layer]").waitFor();
    await openPanel(page, "Quality");
    await expect.poll(() => page.locator("cusp-quality input[type=range]").count()).toBe(1);
    await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain(height_mm.toFixed(1));
    used.push(await usage(page, devtools));
  }
  const megabytes = (bytes: number): string => (bytes / 1e6).toFixed(2);
  for (const [i, it] of used.entries()) {
    console.log(
      `model ${i + 1}: heap ${megabytes(it.heap)} MB, ${it.nodes} nodes, ${it.listeners} listeners, ` +
        `${it.workers} workers of ${it.core.map(megabytes).join(" and ")} MB, ${it.contexts} WebGL contexts`,
    );
  }
  const [early, late] = [used[WARM - 1], used.at(-1)];
  if (early === undefined || late === undefined) throw new Error("nothing was measured");
  expect(late.heap - early.heap).toBeLessThan(HEAP_SLACK_BYTES);
  expect(late.nodes - early.nodes).toBeLessThan(NODE_SLACK);
  expect(late.listeners - early.listeners).toBeLessThan(LISTENER_SLACK);
  expect(late.workers).toBe(early.workers);
  expect(late.contexts).toBe(early.contexts);
  expect(late.contexts).toBe(1);
  expect(late.core).toHaveLength(late.workers);
  for (const [i, bytes] of late.core.entries()) {
    expect(bytes - (early.core[i] ?? 0), `of worker ${i}`).toBeLessThan(CORE_SLACK_BYTES);
  }
}, 240_000);
