/** Measures how long a model of a million facets blocks the page's own thread: `npm run measure-freeze [-- FACETS]`. */
import { launch, SOFTWARE_GPU, open } from "./browser.js";
import { journey, LARGE_FACETS, line, longestWork_ms, torus, TRACED } from "./freeze.js";
import { serve } from "./serve.js";

export async function main([facets = String(LARGE_FACETS)]: string[]): Promise<void> {
  const across = Math.round(Math.sqrt(Number(facets) / 4));
  const stl = torus(2 * across, across);
  const served = await serve();
  const browser = await launch(SOFTWARE_GPU);
  try {
    const { page } = await open(browser, served.address);
    await browser.startTracing(page, { categories: TRACED });
    const { stages, read, copied } = await journey(page, stl);
    const work_ms = longestWork_ms(await browser.stopTracing());
    console.log(`${4 * across * across} facets, ${(stl.length / 1e6).toFixed(1)} MB`);
    for (const stage of stages) console.log(line(stage));
    console.log(`longest work at a stretch ${work_ms.toFixed(0)} ms of processor time`);
    console.log(`read in the page ${read} B, copied into messages to the worker ${copied} B`);
  } finally {
    await browser.close();
    await served.close();
  }
}
