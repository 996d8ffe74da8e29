/**
 * Measures how long a print file takes in the browser, from the call to its Blob, once its masks are shown, with one worker and with
 * several: `npm run measure-print [-- FILE.stl [HEIGHT_MM]]`. On a 12K screen, in layers of 0.05 mm. Without a file, the model is a ball
 * of 40 mm and 80,000 facets.
 *
 * The first file includes starting the helpers, as when a user presses the button.
 */
import { readFile } from "node:fs/promises";
import type * as Api from "../src/api/index.js";
import { onApiPage } from "./packed.js";
import { sphere } from "./solids.js";

const ROUNDS = 5;
const FORMATS = ["png", "sl1", "goo"] as const;

export async function main([file, height = "40"]: string[]): Promise<void> {
  const model = file === undefined ? sphere(20, 284).bytes : await readFile(file);
  await onApiPage(model, async (page) => {
    const cores = await page.evaluate(() => navigator.hardwareConcurrency);
    console.log(`${(model.length - 84) / 50} facets, ${height} mm high, 11520 × 5120 pixels, ${cores} cores, ${ROUNDS} rounds`);
    for (const format of FORMATS) {
      for (const workers of [1, cores]) {
        const { ms, bytes, layers, sum } = await page.evaluate(
          async ([workers, rounds, format, height_mm]) => {
            const { createSlicer } = (window as unknown as { api: typeof Api }).api;
            const options: Api.Options = { height_mm, format, pixels: [11520, 5120], pitch_mm: 0.019, pitch_y_mm: 0.024, planner: { kind: "uniform", layer_mm: 0.05 }, backend: "cpu" };
            const slicer = createSlicer({ workers });
            await slicer.load("model.stl");
            const { report } = await slicer.plan(options);
            await slicer.mask(0);
            const ms: number[] = [];
            let blob = new Blob();
            for (let round = 0; round < rounds; round++) {
              const began = performance.now();
              ({ blob } = await slicer.export());
              ms.push(Math.round(performance.now() - began));
            }
            const content = new Uint8Array(await blob.arrayBuffer());
            const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", content));
            slicer.dispose();
            return { ms, bytes: blob.size, layers: report.layers, sum: [...hash.slice(0, 4)].join(".") };
          },
          [workers, ROUNDS, format, Number(height)] as const,
        );
        console.log(`${format}, ${workers} workers: ${layers} layers, ${bytes} bytes (${sum}) in ${ms.join(", ")} ms`);
      }
    }
  });
}
