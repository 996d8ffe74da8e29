/** Plans with a GPU, in software here, and without one. */
import { expect, test } from "vitest";
import { drop, layers, SOFTWARE_GPU, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };

const start = pages(SOFTWARE_GPU);
const startWithout = pages();

test("the GPU gives the plan that the CPU gives", async (context) => {
  const counts: number[] = [];
  for (const [query, ran] of [
    ["backend=cpu", "Computed on the CPU"],
    ["backend=gpu", "filling"],
  ] as const) {
    // A view that is quick to draw in software.
    const page = await start(`?rays=256&${query}`, { viewport: { width: 1280, height: 400 }, deviceScaleFactor: 0.5 });
    const hasAdapter = await page.evaluate(async () => (await navigator.gpu?.requestAdapter()) != null);
    if (!hasAdapter) context.skip("this browser offers no WebGPU adapter");
    await drop(page, ballFile);
    await state(page, "done", 60_000);
    expect(await words(page)).toContain(ran);
    counts.push(await layers(page));
  }
  expect(new Set(counts).size).toBe(1);
});

test("where there is no GPU a plan is made without, and one that must have it says so", async () => {
  const page = await startWithout("?rays=256&backend=auto");
  await drop(page, ballFile);
  await state(page, "done");
  await expect.poll(() => words(page)).toContain("Computed on the CPU");
  const other = await startWithout("?rays=256&backend=gpu");
  await drop(other, ballFile);
  await state(other, "error");
  await expect.poll(() => words(other)).toContain("No usable GPU");
});
