/** Measures how long the page's own thread is blocked while the page handles a large model. */
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { binaryStl } from "../src/page/example.js";
import { download, openPanel, settled, state } from "./browser.js";

/** Longer than a plan of a large model takes on a slow machine, ms. */
const PATIENCE_MS = 240_000;

/** Facets of the large model, a ring. */
export const LARGE_FACETS = 1 << 20;

/** A torus that lies on the plate: a grid of `around` by `across` quads, two facets each. */
export function torus(around: number, across: number, radius_mm = 15, tube_mm = 5): Uint8Array {
  const corner = (i: number, j: number): [number, number, number] => {
    const [turn, bend] = [(2 * Math.PI * (i % around)) / around, (2 * Math.PI * (j % across)) / across];
    const out = radius_mm + tube_mm * Math.cos(bend);
    return [out * Math.cos(turn), out * Math.sin(turn), tube_mm + tube_mm * Math.sin(bend)];
  };
  const triangles = new Float32Array(18 * around * across);
  let at = 0;
  for (let i = 0; i < around; i++) {
    for (let j = 0; j < across; j++) {
      const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
      for (const point of [a, b, c, a, c, d]) {
        triangles.set(point, at);
        at += 3;
      }
    }
  }
  return binaryStl(triangles);
}

/** A period in which the page could not respond. */
export interface Hold {
  /** On the page's clock, ms. */
  start_ms: number;
  duration_ms: number;
  /** What ran, as far as the browser reports it. */
  cause: string;
}

export interface Stage {
  name: string;
  took_ms: number;
  /** Tasks of more than 50 ms, as the browser counts them. */
  tasks: Hold[];
  /** Late frames, and the scripts that delayed them. */
  frames: Hold[];
}

interface Meter {
  tasks: Hold[];
  frames: Hold[];
  /** Bytes of files that were read in the page itself. */
  read: number;
  /** Bytes that the page copied into messages to its workers. */
  copied: number;
  /** Most corners in one call that drew on the canvas itself, which may block the page until the picture is ready. */
  drawn: number;
}

export interface Journey extends Pick<Meter, "read" | "copied" | "drawn"> {
  stages: Stage[];
}

declare global {
  interface Window {
    meter: Meter;
  }
}

/** Runs before the page's own scripts: records what blocks the page, and the bytes that it reads and copies itself. */
function meter(): void {
  const found: Meter = { tasks: [], frames: [], read: 0, copied: 0, drawn: 0 };
  window.meter = found;
  const hold = ({ startTime, duration }: PerformanceEntry, cause: string): Hold => ({
    start_ms: startTime,
    duration_ms: duration,
    cause,
  });
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) found.tasks.push(hold(entry, ""));
  }).observe({ type: "longtask" });
  interface Script {
    duration: number;
    invoker: string;
    sourceFunctionName: string;
  }
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries() as (PerformanceEntry & { scripts: Script[] })[]) {
      const cause = entry.scripts.map((it) => `${Math.round(it.duration)} ms ${it.invoker} ${it.sourceFunctionName}`);
      found.frames.push(hold(entry, cause.join("; ")));
    }
  }).observe({ type: "long-animation-frame" });

  const { arrayBuffer, text } = Blob.prototype;
  Blob.prototype.arrayBuffer = function () {
    found.read += this.size;
    return arrayBuffer.call(this);
  };
  Blob.prototype.text = function () {
    found.read += this.size;
    return text.call(this);
  };
  const { readAsArrayBuffer } = FileReader.prototype;
  FileReader.prototype.readAsArrayBuffer = function (blob) {
    found.read += blob.size;
    readAsArrayBuffer.call(this, blob);
  };
  const weigh = (value: unknown, moved: readonly unknown[]): number => {
    if (ArrayBuffer.isView(value)) return moved.includes(value.buffer) ? 0 : value.byteLength;
    if (value instanceof ArrayBuffer) return moved.includes(value) ? 0 : value.byteLength;
    if (Array.isArray(value)) return value.reduce<number>((sum, it) => sum + weigh(it, moved), 0);
    // A module is shared, a file is a handle, a port is transferred.
    if (value === null || typeof value !== "object" || Object.getPrototypeOf(value) !== Object.prototype) return 8;
    return Object.values(value).reduce<number>((sum, it) => sum + weigh(it, moved), 0);
  };
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (message: unknown, moved?: Transferable[] | StructuredSerializeOptions) {
    const transfer = Array.isArray(moved) ? moved : (moved?.transfer ?? []);
    found.copied += weigh(message, transfer);
    postMessage.call(this, message, { transfer });
  };
  const { drawArrays } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawArrays = function (mode, first, count) {
    if (this.getParameter(this.DRAW_FRAMEBUFFER_BINDING) === null) found.drawn = Math.max(found.drawn, count);
    drawArrays.call(this, mode, first, count);
  };
}

/** Loads, plans and exports, and returns what blocked the page in each stage. */
export async function journey(page: Page, stl: Uint8Array): Promise<Journey> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-large-"));
  try {
    const path = join(folder, "ring.stl");
    await writeFile(path, stl);
    await page.addInitScript(meter);
    await page.reload();
    await state(page, "empty");
    const stages: Stage[] = [];
    let from = await page.evaluate(() => performance.now());
    const stage = async (name: string, act: () => Promise<unknown>): Promise<void> => {
      await act();
      const to = await page.evaluate(() => performance.now());
      // Entries arrive after what they describe.
      await page.waitForTimeout(300);
      const holds = await page.evaluate(() => ({ tasks: window.meter.tasks, frames: window.meter.frames }));
      const within = ({ start_ms, duration_ms }: Hold): boolean => start_ms + duration_ms > from && start_ms < to;
      stages.push({ name, took_ms: to - from, tasks: holds.tasks.filter(within), frames: holds.frames.filter(within) });
      from = to;
    };
    await stage("load and plan", async () => {
      await page.getByLabel(/Choose a file/).setInputFiles(path);
      await state(page, "done", PATIENCE_MS);
    });
    await stage("view and mask", async () => {
      await openPanel(page, "Mask");
      await page.waitForSelector("canvas[data-layer]", { timeout: PATIENCE_MS });
      // The view states the size of the model once it has the model.
      await page.waitForFunction(
        () => {
          const card = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-model");
          const said = card?.shadowRoot?.querySelector("cusp-view")?.shadowRoot?.querySelector("#state")?.textContent ?? "";
          return /40\.0/.test(said);
        },
        undefined,
        { timeout: PATIENCE_MS },
      );
      await page.waitForTimeout(500);
    });
    await stage("plan anew", async () => {
      await page.getByLabel("Tolerance", { exact: true }).fill("0.05");
      await settled(page);
    });
    await stage("export", async () => {
      const file = await download(page);
      await file.path();
      await state(page, "done", PATIENCE_MS);
    });
    const { read, copied, drawn } = await page.evaluate(() => window.meter);
    return { stages, read, copied, drawn };
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

/** The trace categories that cover the page's thread. */
export const TRACED = ["toplevel"];

interface TraceEvent {
  name: string;
  pid: number;
  tid: number;
  /** CPU time of the thread, µs: excludes whatever else the machine does. */
  tdur?: number;
  args?: { name?: string };
}

/** The longest that a page's thread worked at a stretch, in CPU time, ms. */
export function longestWork_ms(trace: Uint8Array): number {
  const { traceEvents } = JSON.parse(new TextDecoder().decode(trace)) as { traceEvents: TraceEvent[] };
  const isPage = new Set<string>();
  for (const { name, pid, tid, args } of traceEvents) {
    if (name === "thread_name" && args?.name === "CrRendererMain") isPage.add(`${pid} ${tid}`);
  }
  const work = traceEvents.filter((it) => it.name.endsWith("RunTask") && it.tdur !== undefined && isPage.has(`${it.pid} ${it.tid}`));
  if (work.length === 0) throw new Error("the browser traced no work of a page");
  return work.reduce((most, { tdur = 0 }) => Math.max(most, tdur), 0) / 1000;
}

/** Summary of a stage. */
export const line = ({ name, took_ms, tasks, frames }: Stage): string => {
  const longest = (holds: readonly Hold[]): string => `${Math.round(Math.max(0, ...holds.map((it) => it.duration_ms)))} ms`;
  const why = frames.map(({ duration_ms, cause }) => `\n    frame of ${Math.round(duration_ms)} ms: ${cause}`).join("");
  return `${name}: ${(took_ms / 1000).toFixed(1)} s, longest task ${longest(tasks)}, latest frame ${longest(frames)}${why}`;
};
