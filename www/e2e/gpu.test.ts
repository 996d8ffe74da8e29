/** Plans on a GPU, which is software here. */
import { expect, test } from "vitest";
import { drop, layers, SOFTWARE_GPU, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const ballFile = { name: "ball.stl", bytes: sphere(10, 96).bytes };

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
    const page = await start(`?rays=512&${query}`);
    await drop(page, ballFile);
    await state(page, "done", 60_000);
    expect(await words(page)).toContain(ran);
    counts.push(await layers(page));
  }
  expect(new Set(counts).size).toBe(1);
});

test("what drives a GPU is fetched when a plan wants one, and a plan that cannot have it says so", async () => {
  const fetched: string[] = [];
  for (const [query, ends] of [
    ["backend=cpu", "done"],
    ["backend=auto", "done"],
    ["backend=gpu", "error"],
  ] as const) {
    const page = await start(`?rays=512&${query}`);
    await page.route(/cusp_gpu_bg[^/]*\.wasm$/, async (route) => {
      fetched.push(query);
      await route.abort();
    });
    await drop(page, ballFile);
    await state(page, ends, 60_000);
    if (ends === "error") await expect.poll(() => words(page)).toContain("No usable GPU");
  }
  expect(fetched).toEqual(["backend=gpu"]);
});

test("a GPU of WebGPU's compatibility mode peels", async (context) => {
  if (!(await hasAdapter())) context.skip("this browser offers no WebGPU adapter");
  const page = await start("?backend=gpu&rays=512");
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
