/**
 * Measures how long the headless slicer takes at each stage from an abort to the rejected call, and from there to the next
 * plan: `npm run measure-cancel [-- FILE.stl]`. Without a file the model is a sphere of half a million facets.
 */
import { readFile } from "node:fs/promises";
import type * as Api from "../src/api/index.js";
import { onApiPage } from "./packed.js";
import { sphere } from "./solids.js";

const ROUNDS = 5;
const STAGES = ["load", "ldi", "profile", "plan", "masks"] as const;

export async function main([file]: string[]): Promise<void> {
  const model = file === undefined ? sphere(10, 700).bytes : await readFile(file);
  await onApiPage(model, async (page) => {
    for (const stage of STAGES) {
      const rounds = await page.evaluate(
        async ([stage, rounds]) => {
          const { createSlicer } = (window as unknown as { api: typeof Api }).api;
          const found: { cancel_ms: number; again_ms: number }[] = [];
          const options = { rays: 2048, backend: "cpu" } as const;
          for (let round = 0; round < rounds; round++) {
            const slicer = createSlicer();
            await slicer.load("model.stl");
            if (stage === "masks") await slicer.plan(options);
            const abort = new AbortController();
            let aborted = 0;
            const onProgress = (at: string): void => {
              if (at !== stage || aborted > 0) return;
              aborted = performance.now();
              abort.abort();
            };
            const call = { signal: abort.signal, onProgress };
            const running =
              stage === "load" ? slicer.load("model.stl", call) : stage === "masks" ? slicer.export(options, call) : slicer.plan(options, call);
            const name = await running.then(
              () => "",
              (error: Error) => error.name,
            );
            const rejected = performance.now();
            await slicer.plan(options);
            // A stage of a few milliseconds may have ended before the abort.
            if (name === "AbortError") found.push({ cancel_ms: rejected - aborted, again_ms: performance.now() - rejected });
            slicer.dispose();
          }
          return found;
        },
        [stage, ROUNDS] as const,
      );
      const worst = (key: keyof (typeof rounds)[number]): string => Math.max(...rounds.map((round) => round[key])).toFixed(1);
      console.log(`${stage}: ${rounds.length} of ${ROUNDS} aborted, ${worst("cancel_ms")} ms at most; the next plan after ${worst("again_ms")} ms`);
    }
  });
}
