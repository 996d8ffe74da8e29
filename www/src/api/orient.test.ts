import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { WorkerHandle } from "./calls.js";
import { fakeWorker } from "./fake-worker.js";
import { createSlicer, type OrientCall, type Slicer } from "./index.js";
import { workersFor } from "./pool.js";
import { packed, unpackedMeasured } from "./candidates.js";
import type { Candidate, MeshInfo, Preview, Report, SearchStep, Task, TaskResult } from "./wire.js";

const COUNT = 100;
const FACETS = 12;

const candidateAt = ([x = 0, y = 0, z = 0]: Iterable<number>): Candidate => ({
  direction: [x, y, z],
  rotation: [0, 0, 0, 1],
  size_mm: [1, 1, 1],
  excluded: null,
  metrics: { layers: x, print_time_s: 0, max_error: 0, roughness_mm: 0, overhang_mm2: 0, islands: 0, cups_mm2: 0, support_ml: 0, contact_mm2: 0 },
  energy: null,
});

interface Faked {
  slicer: Slicer;
  /** `worker: call`. */
  log: string[];
  /** Numbers of the running workers. */
  live: Set<number>;
}

interface Setup {
  workers: number;
  /** Milliseconds that a worker takes for each call except `advance`. */
  slowness?: (worker: number) => number;
  /** Name of a call that never ends. */
  hangs?: string;
  /** A call that fails in this worker. */
  fails?: readonly [worker: number, call: string];
  /** Directions closer than this to 42 are refined. */
  within?: number;
}

/** Task `REFINING + i` refines direction i. */
const REFINING = 1000;
/** Directions per task. */
const CHUNK = 10;

/** The search of a fake core. The energy of direction i is |i - 42|, and refining halves it. */
class FakeSearch {
  readonly #found: (Candidate | null)[];
  readonly #refined: Candidate[] = [];
  readonly #within: number;
  #waiting: Task[];
  /** The number of outstanding tasks. */
  #out = 0;

  constructor(count: number, within: number, measured: readonly Candidate[] | null) {
    this.#found = measured === null ? Array.from({ length: count }, () => null) : [...measured];
    this.#within = within;
    const tasks = Array.from({ length: Math.ceil(count / CHUNK) }, (_, number): Task => {
      const places = [...Array(count).keys()].slice(CHUNK * number, CHUNK * (number + 1));
      return { number, directions: places.map((place) => [place, 0, 0]) };
    });
    this.#waiting = measured === null ? tasks : this.#refinements();
  }

  advance(results: readonly TaskResult[], most: number, rateFrom: number): SearchStep {
    for (const { number, candidates: numbers } of results) {
      const candidates = unpackedMeasured(numbers);
      this.#out -= 1;
      if (number >= REFINING) this.#refined.push(...this.#rated(candidates, 0.5));
      else for (const candidate of candidates) this.#found[candidate.direction[0]] = candidate;
      if (number < REFINING && this.#measured() === this.#found.length) this.#waiting.push(...this.#refinements());
    }
    const tasks = this.#waiting.splice(0, most);
    this.#out += tasks.length;
    const measured = this.#measured();
    const isDone = this.#out === 0 && this.#waiting.length === 0;
    const rated = this.#found.map((candidate) => (candidate === null ? null : (this.#rated([candidate])[0] ?? null)));
    const result: SearchStep["result"] = {
      best: packed(this.#refined.toSorted((a, b) => (a.energy ?? 0) - (b.energy ?? 0)).slice(0, 3)),
      candidates: packed(rated),
    };
    const progress = isDone ? 1 : (0.8 * measured) / this.#found.length;
    return { tasks, measured, progress, rated: measured >= rateFrom ? packed(rated) : null, result: isDone ? result : null };
  }

  #measured(): number {
    return this.#found.filter((candidate) => candidate !== null).length;
  }

  #refinements(): Task[] {
    const near = [...this.#found.keys()].filter((place) => Math.abs(place - 42) < this.#within);
    return near.map((place) => ({ number: REFINING + place, directions: [[place, 0, 0]] }));
  }

  #rated(candidates: readonly Candidate[], factor = 1): Candidate[] {
    return candidates.map((candidate) => ({ ...candidate, energy: factor * Math.abs(candidate.direction[0] - 42) }));
  }
}

/** A slicer over fake workers. Direction i is [i, 0, 0]. */
function faked({ workers, slowness = () => 0, hangs, fails, within = 4 }: Setup): Faked {
  const log: string[] = [];
  const live = new Set<number>();
  let started = 0;
  const spawn = (): WorkerHandle => {
    const number = ++started;
    live.add(number);
    let search: FakeSearch | null = null;
    const work = async <T>(call: string, answer: () => T): Promise<T> => {
      log.push(`${number}: ${call}`);
      if (hangs === call) await new Promise(() => undefined);
      if (call !== "advance") await new Promise((resolve) => setTimeout(resolve, slowness(number)));
      if (fails?.[0] === number && fails[1] === call) throw { code: "bad-options", message: "no", detail: null };
      return answer();
    };
    const unused = (): never => {
      throw new Error("not asked for by a search");
    };
    const remote: WorkerHandle["remote"] = {
      ...fakeWorker(unused),
      memory: () => 0,
      boot: async () => ({}),
      warmUp: unused,
      add: async (file) => {
        const text = await file.text();
        return work(`add ${text}`, () => ({ info: { facets: FACETS, search_bytes: 0 } as MeshInfo }));
      },
      setWeights: (_model, weights) => void log.push(`${number}: setWeights ${weights?.join() ?? "none"}`),
      startSearch: (_model, _options, { directions = COUNT }, measured) => {
        search = new FakeSearch(directions, within, measured === null ? null : unpackedMeasured(measured));
        return Float64Array.from({ length: 3 * directions }, (_, i) => (i % 3 === 0 ? i / 3 : 0));
      },
      advanceSearch: (results, most, rateFrom) =>
        work("advance", () => {
          if (search === null) throw new Error("another worker has the search");
          return search.advance(results, most, rateFrom);
        }),
      evaluate: (_model, _options, tasks) => {
        const call = tasks.some(({ number }) => number < REFINING) ? "measure" : "refine";
        return work(call, () => tasks.map(({ number, directions }) => ({ number, candidates: packed(directions.map(candidateAt)) })));
      },
      remove: () => undefined,
      plan: async () => ({ report: { schema: 3, print_time_s: 0, resin_ml: 0, plates: [{} as Report] }, profiles: [] }),
      preview: () => ({ report: {} as Preview, profile: new Float32Array() }),
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

test("a direction of one's own is measured by one worker, without a search", async () => {
  const { slicer, log } = faked({ workers: 3 });
  await slicer.load(new Blob(["a"]));
  log.length = 0;
  expect(await slicer.measure({}, [7, 0, 0])).toEqual(candidateAt([7, 0, 0]));
  expect(workersOf(log, "measure").size).toBe(1);
  expect(log.filter((line) => line.endsWith("advance"))).toEqual([]);
});

test("candidates are rated and in the order of directions; the best are refined, lowest energy first", async () => {
  const { found } = await searched({ workers: 2 });
  expect(found.candidates.map(({ direction: [x] }) => x)).toEqual([...Array(COUNT).keys()]);
  expect(found.candidates.map(({ energy }) => energy)).toEqual([...Array(COUNT).keys()].map((x) => Math.abs(x - 42)));
  expect(found.best.map(({ energy }) => energy)).toEqual([0, 0.5, 0.5]);
});

test("the result depends neither on the number of workers nor on their speed", async () => {
  const speeds = [() => 0, (worker: number) => 4 * worker, (worker: number) => 22 - 5 * worker];
  const answers = [];
  for (const workers of [1, 2, 3]) {
    for (const slowness of speeds) {
      const { found, log } = await searched({ workers, slowness });
      answers.push(JSON.stringify(found));
      // The first worker is for plans.
      expect(workersOf(log, "measure").size).toBe(workers);
      expect(log.filter((line) => line.startsWith("1: "))).toEqual(["1: add a"]);
    }
  }
  expect(new Set(answers).size).toBe(1);
});

test("candidates are reported as they are measured, and progress rises to 1", async () => {
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
        expect(candidates).toHaveLength(COUNT);
        const there = candidates.flatMap((candidate, place) => (candidate === null ? [] : { candidate, place }));
        for (const { candidate, place } of there) expect(candidate).toMatchObject({ direction: [place, 0, 0], energy: Math.abs(place - 42) });
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

test("candidates of an earlier search are rated and refined without being measured again", async () => {
  const { slicer, log, found } = await searched({ workers: 2 });
  log.length = 0;
  const again = await slicer.orient({}, { directions: COUNT, alpha: 1 }, { measured: found.candidates });
  expect(again).toEqual(found);
  expect(workersOf(log, "measure").size).toBe(0);
  expect(workersOf(log, "refine").size).toBeGreaterThan(0);
});

test.each(["measure", "refine", "advance", "add a"])("an abort during %s terminates the busy workers, not the main one", async (hangs) => {
  const { slicer, live, log } = faked({ workers: 2, hangs: hangs === "add a" ? "nothing" : hangs });
  await slicer.load(new Blob(["a"]));
  const before = [...live];
  const abort = new AbortController();
  const running = slicer.orient({}, { directions: COUNT }, { signal: abort.signal });
  const outcome = expect(running).rejects.toMatchObject({ name: "AbortError" });
  await vi.waitFor(() => expect(workersOf(log, hangs).size).toBeGreaterThan(0));
  abort.abort();
  await outcome;
  // Workers without a call may stay.
  const busy = new Set(log.filter((line) => line.endsWith(hangs)).map((line) => Number(line.split(":")[0])));
  for (const worker of live) if (!before.includes(worker)) expect(busy).not.toContain(worker);
  expect(before.every((worker) => live.has(worker))).toBe(true);
});

test("the worker that holds the search runs tasks only if no other worker is free", async () => {
  const { log } = await searched({ workers: 3, within: 1 });
  // Workers 2 to 4 are the pool's; worker 2 coordinates.
  expect(workersOf(log, "advance")).toEqual(new Set(["2"]));
  expect(workersOf(log, "measure")).toEqual(new Set(["2", "3", "4"]));
  expect(workersOf(log, "refine").size).toBe(1);
  expect(workersOf(log, "refine")).not.toContain("2");
});

test("aborting a queued search leaves the running one alone", async () => {
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

test.each(["measure", "refine"])("an error in one worker during %s fails the search", async (call) => {
  const it = faked({ workers: 3, fails: [3, call], slowness: () => 5 });
  await it.slicer.load(new Blob(["a"]));
  let told = 0;
  const running = it.slicer.orient({}, { directions: COUNT }, { onProgress: () => told++ });
  await expect(running).rejects.toMatchObject({ name: "SlicerError", code: "bad-options" });
  const before = told;
  await vi.advanceTimersByTimeAsync(100);
  expect(told).toBe(before);
});

test("each worker uses the model and the weights at the time of the call, whatever changes later", async () => {
  const { slicer, log } = faked({ workers: 2, slowness: () => 3 });
  await expect(slicer.orient()).rejects.toMatchObject({ code: "no-model" });
  await slicer.load(new Blob(["a"]));
  await slicer.setWeights(Float32Array.of(0.5));
  const running = slicer.orient({}, { directions: COUNT });
  void slicer.setWeights(null);
  await slicer.load(new Blob(["b"]));
  await running;
  expect(log.filter((line) => /^[23]: (add|setWeights)/.test(line)).toSorted()).toEqual([
    "2: add a",
    "2: setWeights 0.5",
    "3: add a",
    "3: setWeights 0.5",
  ]);
  await slicer.orient({}, { directions: COUNT });
  expect(log.filter((line) => /^[23]: (add|setWeights)/.test(line)).toSorted().filter((line) => line.includes("b"))).toEqual(["2: add b", "3: add b"]);
});

test("idle workers are terminated after a while, and on request", async () => {
  const { slicer, live } = await searched({ workers: 2 });
  expect(live.size).toBe(3);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(live.size).toBe(1);
  await slicer.orient({}, { directions: COUNT });
  expect(live.size).toBe(3);
  slicer.rest();
  expect(live.size).toBe(0);
});

test("a large model gets fewer workers, but at least one", () => {
  const of = (search_bytes: number, most = 64): number => workersFor({ file: new Blob([]), search_bytes }, most);
  expect(of(1000)).toBe(8);
  expect(of(1000, 2)).toBe(2);
  expect(of(250e6)).toBe(2);
  expect(of(8e9)).toBe(1);
});
