import { launch } from "./browser.js";
import { serveView } from "./view-serve.js";
export async function main([around = "320", width = "1000"]: string[]): Promise<void> {
  const served = await serveView();
  const browser = await launch(["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]);
  try {
    const page = await (await browser.newContext({ viewport: { width: Number(width), height: 700 }, reducedMotion: "reduce" })).newPage();
    await page.goto(served.address);
    await page.waitForFunction(() => "harness" in window);
    console.log(await page.evaluate(async (n) => {
      const { harness } = window;
      const positions = harness.solids.ball(20, n);
      const z = Array.from({ length: 801 }, (_, i) => i * 0.05);
      harness.show();
      const canvas = () => harness.view.shadowRoot!.querySelector("canvas")!;
      const gl = () => canvas().getContext("webgl2")!;
      const out: Record<string, unknown> = { facets: positions.length / 9 };
      const finish = (): void => { gl().finish(); const p = new Uint8Array(4); gl().readPixels(0, 0, 1, 1, gl().RGBA, gl().UNSIGNED_BYTE, p); };
      let t = performance.now();
      harness.view.positions = positions; harness.view.z_mm = z; harness.view.thickness_mm = z.slice(1).map(() => 0.05); harness.view.limits = [0.03, 0.1];
      await harness.view.updateComplete;
      out["set"] = performance.now() - t;
      await harness.drawn(); finish();
      out["first"] = performance.now() - t;
      const measure = async (name: string, change: (i: number) => void): Promise<void> => {
        const js = [], all = [];
        for (let i = 0; i < 4; i++) {
          const t = performance.now();
          change(i);
          await harness.view.updateComplete;
          js.push(Math.round(performance.now() - t));
          await new Promise(requestAnimationFrame); finish();
          all.push(Math.round(performance.now() - t));
        }
        out[name] = { js, all };
      };
      await measure("turn model", (i) => (harness.view.rotation = [0, 0, Math.sin(i / 50), Math.cos(i / 50)]));
      await measure("new plan", () => (harness.view.z_mm = z.map((v) => v)));
      await measure("view", () => harness.view.shadowRoot!.querySelector(".stage")!.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true })));
      await measure("aligned", (i) => { harness.view.aligned = true; harness.view.layer = i; });
      return JSON.stringify(out, null, 1).replace(/\n\s+(\d|\])/g, " $1");
    }, Number(around)));
  } finally { await browser.close(); await served.close(); }
}
