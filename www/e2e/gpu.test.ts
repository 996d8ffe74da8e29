/** Plans on a GPU, which is software here, and without one. */
import { expect, inject, test } from "vitest";
import { drop, launch, layers, open, SOFTWARE_GPU, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 48).bytes };

const start = pages(SOFTWARE_GPU);

/** Whether this browser offers a WebGPU adapter. */
async function hasAdapter(): Promise<boolean> {
  const probe = await start();
  return probe.evaluate(async () => (await navigator.gpu?.requestAdapter()) != null);
}

test("the GPU gives the plan that the CPU gives, by either method", async (context) => {
  if (!(await hasAdapter())) context.skip("this browser offers no WebGPU adapter");
  const counts: number[] = [];
  for (const [query, ran] of [
    ["backend=cpu", "Computed on the CPU"],
    ["backend=gpu", "filling"],
    ["backend=gpu&gpu-method=peel", "depth peeling"],
  ] as const) {
    const page = await start(`?rays=256&${query}`);
    await drop(page, ballFile);
    await state(page, "done", 60_000);
    expect(await words(page)).toContain(ran);
    counts.push(await layers(page));
  }
  expect(new Set(counts).size).toBe(1);
});

test("a GPU of WebGPU's compatibility mode peels", async (context) => {
  if (!(await hasAdapter())) context.skip("this browser offers no WebGPU adapter");
  const page = await start("?backend=gpu&rays=256");
  await page.route(/worker-[^/]*\.js$/, async (route) => {
    const response = await route.fetch();
    const lesser = `{
      const request = GPU.prototype.requestAdapter;
      GPU.prototype.requestAdapter = function (options) {
        return options?.featureLevel === "compatibility" ? request.call(this, options) : Promise.resolve(null);
      };
    }`;
    await route.fulfill({ response, body: `${lesser}\n${await response.text()}` });
  });
  await page.reload();
  await drop(page, ballFile);
  await state(page, "done", 60_000);
  expect(await words(page)).toContain("depth peeling");
});

test("where there is no GPU a plan is made without, and one that must have it says so", async () => {
  const browser = await launch();
  try {
    for (const [query, ends, said] of [
      ["backend=auto", "done", "Computed on the CPU"],
      ["backend=gpu", "error", "No usable GPU"],
    ] as const) {
      const { page } = await open(browser, `${inject("address")}?rays=256&${query}`);
      await drop(page, ballFile);
      await state(page, ends);
      await expect.poll(() => words(page)).toContain(said);
    }
  } finally {
    await browser.close();
  }
});
