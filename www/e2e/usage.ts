/** Memory and resources in use by a page and its workers. */
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import type { Browser, CDPSession, Page } from "playwright-core";
import { state } from "./browser.js";

export interface Usage {
  /** Memory of the page itself, bytes: objects, and the storage of their arrays. */
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
export function watchContexts(): void {
  // The picture of work that is kept has a context of its own while it is drawn.
  localStorage.setItem("cusp.work", "off");
  window.contexts = [];
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, ...asked: unknown[]) {
    const context = Reflect.apply(getContext, this, asked) as RenderingContext | null;
    const isKnown = window.contexts.some((it) => it.deref() === context);
    if (context instanceof WebGL2RenderingContext && !isKnown) window.contexts.push(new WeakRef(context));
    return context;
  } as typeof getContext;
}

/** Runs at the top of a worker's script: records the memory of each WebAssembly instance. */
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

async function usageOf(page: Page, devtools: CDPSession): Promise<Usage> {
  // Objects freed by a first collection may have kept others alive.
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

/** Reloads a page, in which {@link watchContexts} must run first, and returns a function that measures its usage. */
export async function watchUsage(page: Page): Promise<() => Promise<Usage>> {
  await page.route(/worker-[^/]*\.js$/, async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, body: WATCH_CORE + (await answer.text()) });
  });
  await page.reload();
  await state(page, "empty");
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Performance.enable");
  return () => usageOf(page, devtools);
}

/** Memory of the browser's page processes, including their workers, bytes: current or peak. Linux only. */
export async function resident(browser: Browser | null, when: "VmRSS" | "VmHWM"): Promise<number | undefined> {
  if (browser === null) return undefined;
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  let sum = 0;
  for (const { type, id } of processInfo) {
    const status = `/proc/${id}/status`;
    if (type !== "renderer" || !existsSync(status)) continue;
    const line = (await readFile(status, "utf8")).split("\n").find((line) => line.startsWith(when));
    sum += 1024 * Number(/\d+/.exec(line ?? "")?.[0] ?? 0);
  }
  return sum === 0 ? undefined : sum;
}

/** Usage in one line. */
export function said(it: Usage): string {
  return (
    `heap ${megabytes(it.heap)} MB, ${it.nodes} nodes, ${it.listeners} listeners, ` +
    `${it.workers} workers of ${it.core.map(megabytes).join(" and ")} MB, ${it.contexts} WebGL contexts`
  );
}

export const megabytes = (bytes: number): string => (bytes / 1e6).toFixed(2);
