import { readFile } from "node:fs/promises";
import { launch } from "./browser.js";
import { serveView } from "./view-serve.js";
import type { Harness } from "./view-page/main.js";
declare global { interface Window { harness: Harness } }
export async function main([model = "fandisk", scheme = "light", extra = "{}", width = "1000", out = "/tmp/o/view"]: string[]): Promise<void> {
  const served = await serveView();
  console.log([...served.sizes]);
  const browser = await launch(["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
  try {
    const page = await (await browser.newContext({ viewport: { width: Number(width), height: 700 }, colorScheme: scheme as "dark", reducedMotion: "reduce" })).newPage();
    page.on("console", (m) => console.log(m.type(), m.text()));
    page.on("pageerror", (m) => console.log("error", m));
    await page.route("**/model.stl", async (r) => r.fulfill({ body: await readFile(`/work/shared/models/${model}.stl`) }));
    await page.goto(served.address);
    await page.waitForFunction(() => "harness" in window);
    const told = await page.evaluate(async (more) => {
      const { harness } = window;
      harness.show(); if (innerWidth < 500) harness.view.style.height = '24rem';
      const stl = await (await fetch("model.stl")).arrayBuffer();
      let positions = harness.facetsOf(stl);
      const properties = JSON.parse(more);
      // fit to 50 mm
      let [lo, hi] = [Infinity, -Infinity];
      for (let i = 2; i < positions.length; i += 3) { lo = Math.min(lo, positions[i]!); hi = Math.max(hi, positions[i]!); }
      const scale = 40 / (hi - lo);
      const z = [0];
      while (z.at(-1)! < 40 - 1e-9) { const t = z.at(-1)! / 40; z.push(Math.min(40, z.at(-1)! + (properties.t ?? 1) * (0.065 + 0.035 * Math.sin(9 * t) ))); }
      delete properties.t;
      const thickness = z.slice(1).map((top, i) => top - z[i]!);
      const t0 = performance.now();
      await harness.set({ positions, scale, z_mm: z, thickness_mm: thickness, limits: [Math.min(...thickness.slice(0, -1)), Math.max(...thickness)], ...properties });
      const first = performance.now() - t0;
      const times = [];
      for (let i = 0; i < 5; i++) {
        const t = performance.now();
        harness.view.rotation = [0, 0, Math.sin(i / 50), Math.cos(i / 50)];
        await harness.set({});
        times.push(Math.round(performance.now() - t));
      }
      await harness.set({rotation: properties.rotation ?? [0,0,0,1]});
      return { facets: positions.length / 9, layers: thickness.length, first, times };
    }, extra);
    console.log(told);
    const t = Date.now();
    if (extra.includes("printed")) { await page.waitForTimeout(400); await page.waitForFunction(() => window.harness.view.building === null, null, { timeout: 60000 }); console.log("steps", Date.now() - t); await page.evaluate(() => window.harness.drawn()); }
    if (extra.includes("flat")) { const b = (await page.locator("cusp-view").boundingBox())!; await page.mouse.move(b.x + b.width / 2, b.y + b.height * 0.45); await page.waitForTimeout(1500); }
    await page.waitForTimeout(300);
    console.log(await page.evaluate(() => JSON.stringify(window.harness.heard)));
    await page.screenshot({ path: `${out}.png` });
  } finally { await browser.close(); await served.close(); }
}
