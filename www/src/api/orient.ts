/** The search for the direction that a model is best built in: over the whole sphere, then more finely around the best. */
import type { About, Watch } from "./client.js";
import type { Pool, Team } from "./pool.js";
import { DEFAULT_SEARCH, type Candidate, type Options, type SearchOptions } from "./wire.js";

/** What is known while directions are measured. */
export interface Found {
  /** Unit vectors in the file's frame, three numbers each. */
  directions: Float64Array;
  /** One for each direction; null where it has not been measured yet. Energies are relative to what has been. */
  candidates: readonly (Candidate | null)[];
}

export interface OrientCall extends Watch {
  /** Told now and then as directions are measured, and once all are. */
  onCandidates?: ((found: Found) => void) | undefined;
  /** Candidates of an earlier search with the same model and options: they are rated anew, and not measured again. */
  measured?: readonly Candidate[] | undefined;
}

/** What a search found. */
export interface Oriented {
  /** One for each direction, rated. */
  candidates: Candidate[];
  /** The best ones that differ from each other, the best first: three at most. */
  best: Candidate[];
}

/** Directions that a worker measures at a time: few, so that all end together, and enough to be worth a message. */
const CHUNK = 16;

/** What finer searches take of all the time, about. */
const REFINEMENT = 0.2;

/** How often what is known is rated while directions are measured. */
const RATINGS = 12;

export function orient(pool: Pool, about: About, options: Options, wanted: SearchOptions, call: OrientCall): Promise<Oriented> {
  const search = { ...DEFAULT_SEARCH, ...wanted };
  return pool.run(about, call, async (team) => {
    const measured = call.measured === undefined ? await measure(team, options, search, call) : [...call.measured];
    const { energies, scale, minima } = await team.ask((remote) => remote.rateCandidates(measured, search));
    const candidates = rated(measured, energies);
    call.onProgress?.("orientation", 1 - REFINEMENT);
    call.onCandidates?.({ directions: directionsOf(candidates), candidates });
    const starts = minima.flatMap((index) => candidates[index] ?? []);
    const refined: Candidate[] = [];
    let done = 0;
    await team.share(
      starts,
      (remote, start) => remote.refineDirection(options, search, scale, start),
      (candidate, index) => {
        refined[index] = candidate;
        call.onProgress?.("orientation", 1 - REFINEMENT * (1 - ++done / starts.length));
      },
    );
    const best = await team.ask((remote) => remote.bestCandidates(refined));
    return { candidates, best };
  });
}

async function measure(team: Team, options: Options, search: Required<SearchOptions>, call: OrientCall): Promise<Candidate[]> {
  call.onProgress?.("orientation", 0);
  const directions = await team.ask((remote) => remote.directions(options, search.directions));
  const count = directions.length / 3;
  const found: (Candidate | null)[] = Array.from({ length: count }, () => null);
  const places = spread(count);
  let measured = 0;
  let toRate = 0;
  let rating: Promise<void> | null = null;

  const rate = async (): Promise<void> => {
    const now = [...found];
    const known = now.filter((candidate) => candidate !== null);
    const { energies } = await team.ask((remote) => remote.rateCandidates(known, search));
    let next = 0;
    const candidates = now.map((it) => (it === null ? null : { ...it, energy: energies[next++] ?? null }));
    call.onCandidates?.({ directions, candidates });
  };

  await team.share(
    places,
    (remote, chunk) => remote.measureDirections(options, gathered(directions, chunk)),
    (candidates, index) => {
      for (const [i, place] of (places[index] ?? []).entries()) found[place] = candidates[i] ?? null;
      measured += candidates.length;
      call.onProgress?.("orientation", (1 - REFINEMENT) * (measured / count));
      if (call.onCandidates === undefined || rating !== null || measured < toRate || measured === count) return;
      toRate = measured + count / RATINGS;
      rating = rate().finally(() => (rating = null));
      // What went wrong goes wrong again when all are rated.
      rating.catch(() => undefined);
    },
  );
  // oxlint-disable-next-line typescript/await-thenable -- a callback has set it, which the compiler does not follow
  await rating;
  return found.flatMap((candidate) => candidate ?? []);
}

/** Places of directions in chunks that each lie all over the sphere, so that it fills everywhere at once. */
function spread(count: number): readonly (readonly number[])[] {
  const chunks = Math.ceil(count / CHUNK);
  return Array.from({ length: chunks }, (_, first) =>
    Array.from({ length: Math.ceil((count - first) / chunks) }, (_, i) => first + i * chunks),
  );
}

function gathered(directions: Float64Array, places: readonly number[]): Float64Array {
  const out = new Float64Array(3 * places.length);
  for (const [i, place] of places.entries()) out.set(directions.subarray(3 * place, 3 * place + 3), 3 * i);
  return out;
}

const rated = (candidates: readonly Candidate[], energies: readonly (number | null)[]): Candidate[] =>
  candidates.map((candidate, i) => ({ ...candidate, energy: energies[i] ?? null }));

const directionsOf = (candidates: readonly Candidate[]): Float64Array =>
  Float64Array.from(candidates.flatMap(({ direction }) => direction));
