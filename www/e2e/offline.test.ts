/** The page without a network, once it has been loaded. */
import { inject, expect, test } from "vitest";
import { launch, layers, open, state } from "./browser.js";
import { sphere } from "./solids.js";

test("loaded once, the page opens and slices without a network", async () => {
  const browser = await launch();
  try {
    const { page, complaints } = await open(browser, inject("address"), { serviceWorkers: "allow" });
    await page.evaluate(async () => void (await navigator.serviceWorker.ready));
    await page.context().setOffline(true);
    await page.goto(`${inject("address")}?height=20`);
    await page.waitForSelector("cusp-workbench[state=empty]");
    // A local file needs no network.
    const input = page.getByLabel(/Choose a file/);
    await input.setInputFiles({ name: "ball.stl", mimeType: "", buffer: Buffer.from(sphere(10, 96).bytes) });
    await state(page, "done");
    expect(await layers(page)).toBeGreaterThan(134);
    // The chart's code is loaded when there is a chart to draw: without a network, from the cache.
    await page.waitForSelector("cusp-chart .plot canvas");
    expect(complaints).toEqual([]);
  } finally {
    await browser.close();
  }
});
