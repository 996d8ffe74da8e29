import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { WorkerHandle } from "./client.js";
import { createSlicer, type OrientCall, type Slicer } from "./index.js";
import { workersFor } from "./pool.js";
import type { Candidate, Preview, MeshInfo, Profiled, Report } from "./wire.js";

const COUNT = 100;
const FACETS = 12;

const candidateAt = ([x = 0, y = 0, z = 0]: Iterable<number>): Candidate => ({
  direction: [x, y, z],
  rotation: [0, 0, 0, 1],
  size_mm: [1, 1, 1],
  excluded: null,
  metrics: { layers: x, print_time_s: 0, max_error: 0, roughness_mm: 0, overhang_mm2: 0 },
  energy: null,
});

interface Faked {
  slicer: Slicer;
  /** `worker: call`. */
  log: string[];
  /** Workers that are there. */
  live: Set<number>;
}

interface Setup {
  workers: number;
  /** Milliseconds that a worker takes for a call. */
  slowness?: (worker: number) => number;
  /** Calls that never end. */
  hangs?: string;
  /** A call of this worker that fails, by its name. */
  fails?: readonly [worker: number, call: string];
}

/** A slicer over fake workers. Direction i is [i, 0, 0]; its energy is how far i is from 42, and refining halves that. */
function faked({ workers, slowness = () => 0, hangs, fails }: Setup): Faked {
  const log: string[] = [];
  const live = new Set<number>();
  let started = 0;
  const spawn = (): WorkerHandle => {
    const number = ++started;
    live.add(number);
    const work = async <T>(call: string, answer: T): Promise<T> => {
      log.push(`${number}: ${call}`);
      if (hangs === call) await new Promise(() => undefined);
      await new Promise((resolve) => setTimeout(resolve, slowness(number)));
      if (fails?.[0] === number && fails[1] === call) throw { code: "bad-options", message: "no", detail: null };
      return answer;
    };
    const unused = (): never => {
      throw new Error("not asked for by a search");
    };
    const remote: WorkerHandle["remote"] = {
      boot: async () => ({}),
      open: async (file) => work(`open ${await file.text()}`, { facets: FACETS } as MeshInfo),
      setWeights: (weights) => void log.push(`${number}: setWeights ${weights?.join() ?? "none"}`),
      directions: (_options, count) => Float64Array.from({ length: 3 * count }, (_, i) => (i % 3 === 0 ? i / 3 : 0)),
      measureDirections: (_options, directions) => {
        const all = Array.from({ length: directions.length / 3 }, (_, i) => candidateAt(directions.subarray(3 * i)));
        return work("measure", all);
      },
      rateCandidates: (candidates) => {
        const energies = candidates.map(({ direction: [x] }) => Math.abs(x - 42));
        const minima = energies.flatMap((energy, i) => (energy < 4 ? i : []));
        return work("rate", { energies, scale: { cost: 1, quality: 1 }, minima });
      },
      refineDirection: (_options, _search, _scale, candidate) =>
        work("refine", { ...candidate, energy: (candidate.energy ?? Infinity) / 2 }),
      bestCandidates: (rated) => rated.toSorted((a, b) => (a.energy ?? 0) - (b.energy ?? 0)).slice(0, 3),
      plan: async () => ({ report: {} as Report, profile: new Float32Array() }),
      preview: () => ({}) as Profiled<Preview>,
      ...{ tradeoff: unused, compare: unused, mask: unused, archive: unused, positions: unused, saliency: unused },
      ...{ weightsFile: unused, readWeights: unused, printers: unused },
    };
    return { remote, terminate: () => live.delete(number), onBroken: () => undefined };
  };
  return { slicer: createSlicer({ spawn, workers }), log, live };
}

async function searched(setup: Setup, call?: OrientCall): Promise<Faked & { found: Awaited<ReturnType<Slicer["orient"]>> }> {
  const it = faked(setup);
  await it.slicer.load(new Blob(["a"]));
  return { ...it, found: await it.slicer.orient({}, { directions: COUNT }, call) };
}

/** The workers that made this call. */
const workersOf = (log: readonly string[], call: string): Set<string> =>
  new Set(log.filter((line) => line.endsWith(`: ${call}`)).map((line) => line.split(":")[0] ?? ""));

beforeEach(() => {
  vi.useFakeTimers({ shouldAdvanceTime: true, advanceTimeDelta: 10 });
});

afterEach(() => {
  vi.useRealTimers();
});

test("candidates come in the order of their directions, rated, and the best of refined ones first", async () => {
  const { found } = await searched({ workers: 2 });
  expect(found.candidates.map(({ direction: [x] }) => x)).toEqual([...Array(COUNT).keys()]);
  expect(found.candidates.map(({ energy }) => energy)).toEqual([...Array(COUNT).keys()].map((x) => Math.abs(x - 42)));
  expect(found.best.map(({ energy }) => energy)).toEqual([0, 0.5, 0.5]);
});

test("the answer does not depend on the number of workers, nor on their speed", async () => {
  const speeds = [() => 0, (worker: number) => 7 * worker, (worker: number) => 40 - 9 * worker];
  const answers = [];
  for (const workers of [1, 2, 3]) {
    for (const slowness of speeds) {
      const { found, log } = await searched({ workers, slowness });
      answers.push(JSON.stringify(found));
      // The first worker is the one that plans.
      expect(workersOf(log, "measure").size).toBe(workers);
      expect(log.filter((line) => line.startsWith("1: "))).toEqual(["1: open a"]);
    }
  }
  expect(new Set(answers).size).toBe(1);
});

test("what is known comes as it is measured, all over the sphere, and progress goes up to its end", async () => {
  const steps: number[] = [];
  const known: number[] = [];
  await searched(
    { workers: 2, slowness: () => 3 },
    {
      onProgress: (stage, fraction) => {
        expect(stage).toBe("orientation");
        steps.push(fraction);
      },
      onCandidates: ({ directions, candidates }) => {
        expect(directions).toHaveLength(3 * COUNT);
        const there = candidates.flatMap((candidate, place) => (candidate === null ? [] : { candidate, place }));
        for (const { candidate, place } of there) expect(candidate).toMatchObject({ direction: [place, 0, 0], energy: Math.abs(place - 42) });
        // No half of the sphere waits for the other.
        const half = there.filter(({ place }) => place < COUNT / 2).length;
        expect(Math.abs(2 * half - there.length)).toBeLessThanOrEqual(2 * 2);
        known.push(there.length);
      },
    },
  );
  expect(known.length).toBeGreaterThan(2);
  expect(known).toEqual(known.toSorted((a, b) => a - b));
  expect(known.at(-1)).toBe(COUNT);
  expect([steps[0], steps.at(-1)]).toEqual([0, 1]);
  expect(steps).toEqual(steps.toSorted((a, b) => a - b));
});

test("candidates at hand are rated and refined without being measured again", async () => {
  const { slicer, log, found } = await searched({ workers: 2 });
  log.length = 0;
  const again = await slicer.orient({}, { directions: COUNT, alpha: 1 }, { measured: found.candidates });
  expect(again).toEqual(found);
  expect(workersOf(log, "measure").size).toBe(0);
  expect(workersOf(log, "refine").size).toBeGreaterThan(0);
});

test.each(["measure", "refine", "rate", "open a"])("an abort during %s ends the workers at once, and the next search starts others", async (hangs) => {
  const { slicer, live, log } = faked({ workers: 2, hangs: hangs === "open a" ? "nothing" : hangs });
  await slicer.load(new Blob(["a"]));
  const before = [...live];
  const abort = new AbortController();
  const running = slicer.orient({}, { directions: COUNT }, { signal: abort.signal });
  const outcome = expect(running).rejects.toMatchObject({ name: "AbortError" });
  await vi.waitFor(() => expect(workersOf(log, hangs).size).toBeGreaterThan(0));
  abort.abort();
  await outcome;
  // Workers that were not asked anything may stay.
  const busy = new Set(log.filter((line) => line.endsWith(hangs)).map((line) => Number(line.split(":")[0])));
  for (const worker of live) if (!before.includes(worker)) expect(busy).not.toContain(worker);
  expect(before.every((worker) => live.has(worker))).toBe(true);
});

test("a search that waits for another is aborted without it", async () => {
  const { slicer, live } = faked({ workers: 1, hangs: "measure" });
  await slicer.load(new Blob(["a"]));
  const first = slicer.orient();
  first.catch(() => undefined);
  await vi.waitFor(() => expect(live.size).toBe(2));
  const abort = new AbortController();
  const second = slicer.orient({}, {}, { signal: abort.signal });
  abort.abort();
  await expect(second).rejects.toMatchObject({ name: "AbortError" });
  expect(live.size).toBe(2);
  slicer.dispose();
  await expect(first).rejects.toMatchObject({ name: "AbortError" });
  await expect(slicer.orient()).rejects.toMatchObject({ name: "AbortError" });
  expect(live.size).toBe(0);
});

test.each(["measure", "refine"])("an error in one worker, during %s, is the search's", async (call) => {
  const it = faked({ workers: 3, fails: [3, call], slowness: () => 5 });
  await it.slicer.load(new Blob(["a"]));
  let told = 0;
  const running = it.slicer.orient({}, { directions: COUNT }, { onProgress: () => told++ });
  await expect(running).rejects.toMatchObject({ name: "SlicerError", code: "bad-options" });
  const before = told;
  await vi.advanceTimersByTimeAsync(100);
  expect(told).toBe(before);
});

test("each worker has the model and the weights of the time of the call, whatever comes later", async () => {
  const { slicer, log } = faked({ workers: 2, slowness: () => 3 });
  await expect(slicer.orient()).rejects.toMatchObject({ code: "no-model" });
  await slicer.load(new Blob(["a"]));
  await slicer.setWeights(Float32Array.of(0.5));
  const running = slicer.orient({}, { directions: COUNT });
  void slicer.setWeights(null);
  await slicer.load(new Blob(["b"]));
  await running;
  expect(log.filter((line) => /^[23]: (open|setWeights)/.test(line)).toSorted()).toEqual([
    "2: open a",
    "2: setWeights 0.5",
    "3: open a",
    "3: setWeights 0.5",
  ]);
  await slicer.orient({}, { directions: COUNT });
  expect(log.filter((line) => /^[23]: (open|setWeights)/.test(line)).toSorted().filter((line) => line.includes("b"))).toEqual(["2: open b", "3: open b"]);
});

test("workers that nobody needs are ended after a while, and on request", async () => {
  const { slicer, live } = await searched({ workers: 2 });
  expect(live.size).toBe(3);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(live.size).toBe(1);
  await slicer.orient({}, { directions: COUNT });
  expect(live.size).toBe(3);
  slicer.rest();
  expect(live.size).toBe(0);
});

test("a large model has fewer workers, and none has none", () => {
  const of = (facets: number, most = 64): number => workersFor({ file: new Blob([]), facets }, most);
  expect(of(1000)).toBe(8);
  expect(of(1000, 2)).toBe(2);
  expect(of(1_500_000)).toBe(2);
  expect(of(50_000_000)).toBe(1);
});
