/**
 * Measures the time and the memory of the core in a browser, without the page around it:
 * `npm run measure-core -- FILE [HEIGHT_MM [RAYS | WIDTHxHEIGHT@PITCH_MM [OPTIONS_AS_JSON]]]`.
 *
 * Reads and plans the same model several times in one tab, as when a user turns it, makes its masks and checks them; then makes a print file. The
 * figures of stages are the core's own, for the CPU backend. Models other than STL are read by the module for them.
 */
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import type { JSHandle } from "playwright-core";
import type { InitOutput, Options } from "../pkg/cusp_slicer.js";
import { launch, SOFTWARE_GPU, open } from "./browser.js";
import { serve } from "./serve.js";

const ROUNDS = 5;

type Core = typeof import("../pkg/cusp_slicer.js");

export async function main([file, height = "60", grid = "2048", more = "{}"]: string[]): Promise<void> {
  if (file === undefined) {
    throw new Error("usage: npm run measure-core -- FILE [HEIGHT_MM [RAYS | WIDTHxHEIGHT@PITCH_MM [OPTIONS_AS_JSON]]]");
  }
  const model = await readFile(file);
  const options: Options = { height_mm: Number(height), backend: "cpu", ...pixels(grid), ...(JSON.parse(more) as Options) };
  const served = await serve();
  const browser = await launch(SOFTWARE_GPU);
  try {
    const { page } = await open(browser, served.address);
    await page.route(`${served.address}core/**`, async (route) => {
      const name = new URL(route.request().url()).pathname.slice("/core/".length);
      const body = name === "model" ? model : await readFile(new URL(`../pkg/${name}`, import.meta.url));
      const types: Record<string, string> = { js: "text/javascript", wasm: "application/wasm" };
      await route.fulfill({ body, contentType: types[name.split(".").at(-1) ?? ""] ?? "application/octet-stream" });
    });
    // As text, because import() in a function would be rewritten for Node.
    const module: JSHandle<Core> = await page.evaluateHandle(`import("${served.address}core/cusp_slicer.js")`);
    const measured = await page.evaluate(
      async ([core, address, options, rounds]) => {
        const { memory }: InitOutput = await core.default();
        const bytes = new Uint8Array(await (await fetch(`${address}core/model`)).arrayBuffer());
        const timings: string[] = [];
        const quiet = (): void => undefined;
        const read = (): InstanceType<Core["Slicer"]> => new core.Slicer(bytes);
        let zip = "";
        for (let round = 0; round < rounds; round++) {
          const clock = performance.now();
          const slicer = read();
          const read_ms = performance.now() - clock;
          const { layers, hits, timings_ms } = await slicer.plan(options, quiet);
          const masking = performance.now();
          slicer.mask(0);
          const checking = performance.now();
          const { counts } = slicer.inspect({}, quiet);
          const [masks_ms, check_ms] = [checking - masking, performance.now() - checking];
          timings.push(`${layers} layers, ${hits} hits: read ${Math.round(read_ms)}, ${Object.entries(timings_ms).map(([stage, ms]) => `${stage} ${Math.round(ms)}`).join(", ")}, masks shown ${Math.round(masks_ms)}, checks ${Math.round(check_ms)} ms (${counts.length} kinds)`);
          if (round === rounds - 1) {
            const start = performance.now();
            let bytes = 0;
            slicer.archive(null, (chunk) => void (bytes += chunk.length), quiet);
            zip = `print file of ${bytes} bytes in ${Math.round(performance.now() - start)} ms`;
          }
          slicer.free();
        }
        return { timings, zip, megabytes: Math.round(memory.buffer.byteLength / 1e6) };
      },
      [module, served.address, options, ROUNDS] as const,
    );
    console.log(`${basename(file)}, ${height} mm high, ${grid}, ${more}, wasm on the CPU`);
    for (const line of [...measured.timings, measured.zip]) console.log(line);
    console.log(`${measured.megabytes} MB of wasm memory at most`);
  } finally {
    await browser.close();
    await served.close();
  }
}

function pixels(grid: string): Options {
  const match = /^(\d+)x(\d+)@([\d.]+)$/.exec(grid);
  if (match === null) return { rays: Number(grid) };
  return { pixels: [Number(match[1]), Number(match[2])], pitch_mm: Number(match[3]) };
}
