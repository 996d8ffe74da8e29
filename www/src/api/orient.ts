/** The orientation search. The core drives it: one worker of the pool holds the search, and all run its tasks. */
import { packed, unpacked, unpackedMeasured } from "./candidates.js";
import type { Watch } from "./calls.js";
import { ALONE, type About } from "./client.js";
import type { Pool } from "./pool.js";
import type { Candidate, Options, SearchOptions, SearchResult, SearchStep, Task, TaskResult } from "./wire.js";

/** Intermediate results of a search, while directions are measured. */
export interface Found {
  /** Unit vectors in the file's frame, three numbers each. */
  directions: Float64Array;
  /** One per direction; null until it is measured. Energies are relative to the directions measured so far. */
  candidates: readonly (Candidate | null)[];
}

export interface OrientCall extends Watch {
  /** Called repeatedly as directions are measured, and at the end. */
  onCandidates?: ((found: Found) => void) | undefined;
  /** Candidates of an earlier search with the same model and options: they are rated again but not measured again. */
  measured?: readonly Candidate[] | undefined;
}

/** Approximate number of calls of `onCandidates`. */
const RATINGS = 12;

/** Measures one direction as a search does. */
export function measure(pool: Pool, about: About, options: Options, direction: Readonly<Candidate["direction"]>, call: Watch): Promise<Candidate> {
  return pool.run(about, call, async (team) => {
    const results = await team.ask((remote) => remote.evaluate(ALONE, options, [{ number: 0, directions: [[...direction]] }]));
    const [candidate] = unpackedMeasured(results[0]?.candidates ?? new Float64Array());
    if (candidate === undefined) throw new Error("the direction was not measured");
    return candidate;
  });
}

export function orient(pool: Pool, about: About, options: Options, search: SearchOptions, call: OrientCall): Promise<SearchResult> {
  const { onProgress, onCandidates } = call;
  return pool.run(about, call, async (team) => {
    onProgress?.("orientation", 0, 0);
    const measured = call.measured === undefined ? null : packed(call.measured);
    const directions = await team.ask((remote) => remote.startSearch(ALONE, options, search, measured));
    const count = directions.length / 3;
    let rateFrom = onCandidates === undefined ? Infinity : 1;
    const { candidates, best } = await team.share({
      exchange: (remote, results: TaskResult[], most) => remote.advanceSearch(results, most, rateFrom),
      run: (remote, tasks: Task[]) => remote.evaluate(ALONE, options, tasks),
      onStep: ({ progress, measured, rated }: SearchStep) => {
        onProgress?.("orientation", progress, progress);
        if (rated === null) return;
        rateFrom = measured === count ? Infinity : Math.min(count, measured + count / RATINGS);
        onCandidates?.({ directions, candidates: unpacked(rated) });
      },
    });
    return { candidates: unpackedMeasured(candidates), best: unpackedMeasured(best) };
  });
}
