/**
 * Measures how long a search for the best orientation takes in the browser, from the call to its answer, with one worker
 * and with several: `npm run measure-directions [-- FILE.stl [HEIGHT_MM [DIRECTIONS]]]`. Without a file, or with `example`
 * in its place, the model is the example with 111,600 facets.
 *
 * The time includes starting the workers, as when a user presses the button.
 */
import { readFile } from "node:fs/promises";
import { binaryStl, exampleTriangles } from "../src/page/example.js";
import type * as Api from "../src/api/index.js";
import { onApiPage } from "./packed.js";
import { finer } from "./solids.js";

const ROUNDS = 5;

/** Selects the example. */
const EXAMPLE = "example";

export async function main([file = EXAMPLE, height, directions = "1000"]: string[]): Promise<void> {
  const model = file === EXAMPLE ? binaryStl(finer(exampleTriangles())) : await readFile(file);
  await onApiPage(model, async (page) => {
    const cores = await page.evaluate(() => navigator.hardwareConcurrency);
    const options = height === undefined ? {} : { height_mm: Number(height) };
    console.log(`${(model.length - 84) / 50} facets, ${directions} directions, ${height === undefined ? "its own height" : `${height} mm high`}, ${cores} cores, ${ROUNDS} rounds`);
    const answers = new Set<string>();
    for (const workers of [1, cores]) {
      const rounds = await page.evaluate(
        async ([workers, directions, rounds, options]) => {
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
            const { candidates, best } = await slicer.orient(options, { directions }, { onCandidates });
            const all_ms = performance.now() - began;
            const rerated = performance.now();
            await slicer.orient(options, { directions, alpha: 0.25 }, { measured: candidates });
            found.push({ first_ms, measured_ms, all_ms, again_ms: performance.now() - rerated, best: JSON.stringify(best) });
            slicer.dispose();
          }
          return found;
        },
        [workers, Number(directions), ROUNDS, options] as const,
      );
      for (const { best } of rounds) answers.add(best);
      const spread = (key: "first_ms" | "measured_ms" | "all_ms" | "again_ms"): string => {
        const sorted = rounds.map((round) => Math.round(round[key])).sort((a, b) => a - b);
        return `${sorted[Math.floor(sorted.length / 2)]} ms (${sorted[0]} to ${sorted.at(-1)})`;
      };
      console.log(`${workers} workers: first colours ${spread("first_ms")}, all measured ${spread("measured_ms")}, all done ${spread("all_ms")}`);
      console.log(`  with another alpha, without measuring anew: ${spread("again_ms")}`);
    }
    console.log(answers.size === 1 ? "the same answer every time" : `${answers.size} different answers`);
  });
}
