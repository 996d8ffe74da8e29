/** A model of a million facets in the page, whose own thread must do little of the work. */
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, inject, test } from "vitest";
import { launch, open } from "./browser.js";
import { journey, LARGE_FACETS, line, longestWork_ms, torus, TRACED } from "./freeze.js";
import { picture, SOFTWARE_GL } from "./view-pages.js";

/** Options, names and handles. The positions alone are 37 MB. */
const MESSAGES_BYTES = 10_000;
/** Corners that may be drawn on the canvas itself. The model has three million. */
const CORNERS = 100_000;
/**
 * How long the page's thread may work at a stretch. This is CPU time, which does not grow with the machine's other load,
 * and several times the usual value; going through all facets at a stretch takes about as much again.
 * `npm run measure-freeze` gives the elapsed time.
 */
const WORK_MS = 500;
/** Least difference between the channels of a pixel that shows the model and not the background, of 255. */
const COLOURED = 40;

let browser: Browser;

beforeAll(async () => {
  browser = await launch(SOFTWARE_GL);
});

afterAll(async () => {
  await browser.close();
});

test("a million facets are loaded, planned and exported beside the page", async () => {
  const stl = torus(1024, 512);
  expect(stl.length).toBe(84 + 50 * LARGE_FACETS);
  const { page, strangers, complaints } = await open(browser, inject("address"));
  await browser.startTracing(page, { categories: TRACED });
  const { stages, read, copied, drawn } = await journey(page, stl);
  const work_ms = longestWork_ms(await browser.stopTracing());
  for (const stage of stages) console.log(line(stage));
  console.log(`longest work at a stretch ${work_ms.toFixed(0)} ms`);

  // In the end the model is there, in the colours of its layers.
  const { width = 0, height = 0 } = (await page.locator("cusp-view").boundingBox()) ?? {};
  await expect
    .poll(async () => {
      const pixel = (await picture(page))(width / 2, height / 3);
      return Math.max(...pixel) - Math.min(...pixel);
    })
    .toBeGreaterThan(COLOURED);

  expect(read).toBe(0);
  expect(copied).toBeLessThan(MESSAGES_BYTES);
  expect(drawn).toBeLessThan(CORNERS);
  expect(work_ms).toBeLessThan(WORK_MS);
  expect(strangers).toEqual([]);
  expect(complaints).toEqual([]);
}, 600_000);
