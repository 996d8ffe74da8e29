/** Measures calls of the headless slicer on an otherwise empty page: an orientation search, and cancels. */
import type { Page } from "playwright-core";
import type * as Api from "../src/api/index.js";
import { launch } from "./browser.js";
import { serveApi } from "./packed.js";

/** Measures on a page with the slicer as `window.api`, and this model as `model.stl`. */
async function onApiPage(model: Uint8Array, measure: (page: Page) => Promise<void>): Promise<void> {
  const served = await serveApi({ "model.stl": model });
  const browser = await launch();
  try {
    const page = await browser.newPage();
    await page.goto(served.address);
    await page.waitForFunction(() => "api" in window);
    await measure(page);
  } finally {
    await browser.close();
    await served.close();
  }
}

const spread = (values: readonly number[]): string => {
  const sorted = values.map(Math.round).sort((a, b) => a - b);
  return `${sorted[Math.floor(sorted.length / 2)]} ms (${sorted[0]} to ${sorted.at(-1)})`;
};

/**
 * From the call to its answer, with one worker and with one per core. The time includes starting the workers, as when a user presses the
 * button.
 */
export async function directions(model: Uint8Array, height_mm: number, rounds: number): Promise<void> {
  await onApiPage(model, async (page) => {
    const cores = await page.evaluate(() => navigator.hardwareConcurrency);
    const answers = new Set<string>();
    for (const workers of [1, cores]) {
      const found = await page.evaluate(
        async ([workers, rounds, height_mm]) => {
          const { createSlicer } = (window as unknown as { api: typeof Api }).api;
          const found: { first_ms: number; measured_ms: number; all_ms: number; again_ms: number; best: string }[] = [];
          for (let round = 0; round < rounds; round++) {
            const slicer = createSlicer({ workers });
            await slicer.load("model.stl");
            const began = performance.now();
            let first_ms = 0;
            let measured_ms = 0;
            const onCandidates = (): void => {
              measured_ms = performance.now() - began;
              first_ms ||= measured_ms;
            };
            const { candidates, best } = await slicer.orient({ height_mm }, {}, { onCandidates });
            const all_ms = performance.now() - began;
            const rerated = performance.now();
            await slicer.orient({ height_mm }, { alpha: 0.25 }, { measured: candidates });
            found.push({ first_ms, measured_ms, all_ms, again_ms: performance.now() - rerated, best: JSON.stringify(best) });
            slicer.dispose();
          }
          return found;
        },
        [workers, rounds, height_mm] as const,
      );
      for (const { best } of found) answers.add(best);
      const times = (key: "first_ms" | "measured_ms" | "all_ms" | "again_ms"): string => spread(found.map((round) => round[key]));
      console.log(`${workers} workers: first colours ${times("first_ms")}, all measured ${times("measured_ms")}, all done ${times("all_ms")}`);
      console.log(`  with another alpha, without measuring anew: ${times("again_ms")}`);
    }
    console.log(answers.size === 1 ? "the same answer every time" : `${answers.size} different answers`);
  });
}

/** At each stage, from an abort to the rejected call, and from there to the next plan. */
export async function cancels(model: Uint8Array, height_mm: number, rounds: number): Promise<void> {
  await onApiPage(model, async (page) => {
    for (const stage of ["load", "ldi", "profile", "plan", "masks"] as const) {
      const found = await page.evaluate(
        async ([stage, rounds, height_mm]) => {
          const { createSlicer } = (window as unknown as { api: typeof Api }).api;
          const found: { cancel_ms: number; again_ms: number }[] = [];
          const options = { height_mm, rays: 2048, backend: "cpu" } as const;
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
        [stage, rounds, height_mm] as const,
      );
      const worst = (key: keyof (typeof found)[number]): string => Math.max(...found.map((round) => round[key])).toFixed(1);
      console.log(`${stage}: ${found.length} of ${rounds} aborted, ${worst("cancel_ms")} ms at most; the next plan after ${worst("again_ms")} ms`);
    }
  });
}
