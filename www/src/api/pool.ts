/** A pool of workers for work that splits into many tasks: each worker holds the model, and free ones take the next tasks. */
import { disposed, untilAborted, type Remote, type Watch } from "./calls.js";
import type { About, Client, Loaded } from "./client.js";

/** More workers are no faster, and each holds the model. */
const MOST_WORKERS = 8;

/** Maximum memory of a search in all workers together. */
const MEMORY_BYTES = 512 << 20;

/** Workers are terminated after this long without work. */
const IDLE_MS = 10_000;

type Signal = Pick<Watch, "signal">;

/** Number of workers for a model: up to `most`, fewer for a large model, at least one. */
export function workersFor({ file, search_bytes }: Pick<Loaded, "file" | "search_bytes">, most: number): number {
  const fitting = Math.floor(MEMORY_BYTES / (search_bytes + file.size));
  return Math.max(1, Math.min(most, MOST_WORKERS, fitting));
}

/** The next tasks; `result` is null until all are done. */
export interface Step<Task> {
  tasks: Task[];
  result: unknown;
}

type Outcome<Next extends Step<unknown>> = NonNullable<Next["result"]>;

/** Work whose tasks one worker hands out and all run. */
export interface Sharing<Task, Result, Next extends Step<Task>> {
  /** Delivers results, in any order, and returns up to `most` further tasks. */
  exchange: (remote: Remote, results: Result[], most: number) => Next | Promise<Next>;
  run: (remote: Remote, tasks: Task[]) => Result[] | Promise<Result[]>;
  /** Called after each exchange. */
  onStep: (step: Next) => void;
}

/** Workers that hold the same model while the pool works on it. */
export interface Team {
  /** Runs a query on the first worker, which stays the same. */
  ask<T>(question: (remote: Remote) => T | Promise<T>): Promise<T>;
  /** Runs tasks until there is a result. The first worker does the exchanges. Rejects with the first failure. */
  share<Task, Result, Next extends Step<Task>>(sharing: Sharing<Task, Result, Next>): Promise<Outcome<Next>>;
}

export class Pool {
  readonly #start: () => Client;
  readonly #most: number;
  readonly #clients: Client[] = [];
  /** Tasks run one at a time. */
  #queue: Promise<unknown> = Promise.resolve();
  #timer: ReturnType<typeof setTimeout> | undefined;
  #isDisposed = false;

  /** @param start creates a client, whose worker starts when first needed */
  constructor(start: () => Client, most: number) {
    this.#start = start;
    this.#most = most;
  }

  run<T>(about: About, { signal }: Signal, task: (team: Team) => Promise<T>): Promise<T> {
    const result = this.#queue.then(async () => {
      signal?.throwIfAborted();
      if (this.#isDisposed) throw disposed();
      clearTimeout(this.#timer);
      try {
        return await task(this.#team(await about, { signal }));
      } finally {
        if (!this.#isDisposed) this.#timer = setTimeout(() => this.rest(), IDLE_MS);
      }
    });
    const forget = (): void => undefined;
    this.#queue = result.then(forget, forget);
    return untilAborted(result, signal);
  }

  /** Terminates the workers until they are needed again. */
  rest(): void {
    clearTimeout(this.#timer);
    for (const client of this.#clients) client.rest();
  }

  /** Terminates the workers for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#isDisposed = true;
    clearTimeout(this.#timer);
    for (const client of this.#clients) client.dispose();
  }

  #team(subject: Loaded, watch: Signal): Team {
    const workers = workersFor(subject, this.#most);
    const about = Promise.resolve(subject);
    const client = (place: number): Client => (this.#clients[place] ??= this.#start());
    const ask = <T>(place: number, question: (remote: Remote) => T | Promise<T>): Promise<T> =>
      client(place).ask(about, watch, (remote) => question(remote));
    return {
      ask: (question) => ask(0, question),
      share: (sharing) => share(workers, ask, sharing),
    };
  }
}

/** Tasks queued per worker, to bridge the time in which the first worker is busy and cannot hand out more. */
const STOCK = 4;

/** Messages per worker over which the queue is spread: few, as each takes time, but enough for all workers to finish together. */
const MESSAGES = 2;

function share<Task, Result, Next extends Step<Task>>(
  workers: number,
  ask: <T>(worker: number, question: (remote: Remote) => T | Promise<T>) => Promise<T>,
  { exchange, run, onStep }: Sharing<Task, Result, Next>,
): Promise<Outcome<Next>> {
  return new Promise((resolve, reject) => {
    const tasks: Task[] = [];
    let results: Result[] = [];
    const idle = Array.from({ length: workers }, (_, worker) => worker);
    let isOver = false;

    const fail = (error: unknown): void => {
      isOver = true;
      reject(error);
    };
    const refill = async (): Promise<void> => {
      const given = results;
      results = [];
      const step = await ask(0, (remote) => exchange(remote, given, STOCK * workers - tasks.length));
      if (isOver) return;
      onStep(step);
      if (step.result !== null) return resolve(step.result as Outcome<Next>);
      tasks.push(...step.tasks);
      free(0);
    };
    const work = async (worker: number, given: Task[]): Promise<void> => {
      const done = await ask(worker, (remote) => run(remote, given));
      results.push(...done);
      free(worker);
    };
    const free = (worker: number): void => {
      idle.push(worker);
      idle.sort((a, b) => a - b);
      if (!isOver) advance();
    };
    /**
     * Gives tasks to the other workers first. All of them wait for the first worker's exchanges, so it runs only a few tasks
     * at a time, and only while there are no results to exchange.
     */
    const advance = (): void => {
      while (tasks.length > 0 && idle.length > 0 && (idle[0] !== 0 || idle.length > 1)) {
        const given = tasks.splice(0, Math.ceil(tasks.length / (MESSAGES * workers)));
        work(idle.pop() as number, given).catch(fail);
      }
      if (idle[0] !== 0 || (results.length === 0 && tasks.length === 0)) return;
      idle.shift();
      const next = results.length > 0 ? refill() : work(0, tasks.splice(0, workers === 1 ? STOCK / MESSAGES : 1));
      next.catch(fail);
    };
    idle.shift();
    refill().catch(fail);
  });
}
