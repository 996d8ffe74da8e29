/** Many models in a row leave no more memory in use than two: six models, or 500 with `npm run endurance`. */
import { expect, test } from "vitest";
import { drop, openPanel, SOFTWARE_GL, state } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";
import { said, watchContexts, watchUsage, type Usage } from "./usage.js";

const MODELS = process.env["ENDURANCE"] === undefined ? 6 : 500;
/** After this many models, everything made only once exists: compiled code, workers, the view. */
const WARM = 2;

/** Points around each model. All models have the same number of facets, and so need the same memory. */
const AROUND = 256;
const FACETS = AROUND * (AROUND - 2);
/** Corners of a model's facets, nine numbers of four bytes each: the minimum size of a leaked model. */
const MODEL_BYTES = FACETS * 9 * 4;

/** Allowance for the browser's compiler and caches in the page: less than two models. */
const HEAP_SLACK_BYTES = 2 * MODEL_BYTES;
/**
 * Maximum number of times that a worker's memory, which never shrinks, may grow because of fragmentation. With a leak, it would grow with
 * each model.
 */
const CORE_GROWS = Math.ceil(MODELS / 5);
/** A leaked model would hold some 600 nodes and 40 listeners. */
const NODE_SLACK = 200;
/** Ports that carried progress are freed only when the worker's own garbage collector runs. */
const LISTENER_SLACK = 100;

const start = pages(SOFTWARE_GL);

test("models in a row leave the memory where it was", async () => {
  const page = await start("?rays=512", { viewport: { width: 1280, height: 400 }, deviceScaleFactor: 0.5, before: watchContexts });
  const usage = await watchUsage(page);
  const used: Usage[] = [];
  for (let i = 1; i <= MODELS; i++) {
    const name = `ball-${i}.stl`;
    // Most are slightly lower than the previous one, so that the freed memory suffices: the test detects leaks, not fragmentation.
    const height_mm = 2 * (12 - 0.1 * ((i - 1) % 10));
    await drop(page, { name, bytes: sphere(height_mm / 2, AROUND).bytes });
    // The previous model stays visible until this one is read.
    await expect.poll(() => page.locator(".model-name").allInnerTexts()).toEqual([name]);
    await state(page, "done");
    // Not `waitForSelector`, whose result would keep the canvas alive.
    await openPanel(page, "Mask");
    await page.locator("canvas[data-layer]").waitFor();
    await openPanel(page, "Quality");
    await expect.poll(() => page.locator("cusp-quality input[type=range]").count()).toBe(1);
    await expect.poll(() => page.locator("cusp-view #state").textContent()).toContain(height_mm.toFixed(1));
    used.push(await usage());
  }
  for (const [i, it] of used.entries()) console.log(`model ${i + 1}: ${said(it)}`);
  const [early, late] = [used[WARM - 1], used.at(-1)];
  if (early === undefined || late === undefined) throw new Error("nothing was measured");
  expect(late.heap - early.heap).toBeLessThan(HEAP_SLACK_BYTES);
  expect(late.nodes - early.nodes).toBeLessThan(NODE_SLACK);
  expect(late.listeners - early.listeners).toBeLessThan(LISTENER_SLACK);
  expect(late.workers).toBe(early.workers);
  expect(late.contexts).toBe(early.contexts);
  expect(late.contexts).toBe(1);
  expect(late.core).toHaveLength(late.workers);
  const inAll = used.slice(WARM - 1).map(({ core }) => core.reduce((sum, bytes) => sum + bytes, 0));
  expect(inAll.filter((bytes, i) => i > 0 && bytes > (inAll[i - 1] ?? 0)).length).toBeLessThanOrEqual(CORE_GROWS);
}, 60_000 + 10_000 * MODELS);
