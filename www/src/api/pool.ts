/** Several workers for work that comes in many parts: each holds the model, and whichever is free takes the next part. */
import { disposed, present, untilAborted, type About, type Client, type Remote, type Subject, type Watch } from "./client.js";

/** More share the work no better, and each holds the model. */
const MOST_WORKERS = 8;

/** What the models in all workers together may take. */
const MEMORY_BYTES = 512 << 20;
/** What a facet takes in the core, in the model and in what is worked out of it once, beside its bytes of the file. */
const FACET_BYTES = 160;

/** Without work for so long, workers are ended. */
const IDLE_MS = 10_000;

type Signal = Pick<Watch, "signal">;

/** How many workers a model is worth. */
export function workersFor({ file, facets }: Pick<Subject, "file" | "facets">, most: number): number {
  const fitting = Math.floor(MEMORY_BYTES / (FACET_BYTES * facets + file.size));
  return Math.max(1, Math.min(most, MOST_WORKERS, fitting));
}

/** Workers that all hold one model, while a task of the pool runs. */
export interface Team {
  ask<T>(question: (remote: Remote) => T | Promise<T>): Promise<T>;
  /** Has each part done by whoever is free, and takes the answers as they come. The first failure ends it. */
  share<Part, T>(
    parts: readonly Part[],
    question: (remote: Remote, part: Part) => T | Promise<T>,
    take: (answer: T, index: number) => void,
  ): Promise<void>;
}

export class Pool {
  readonly #start: () => Client;
  readonly #most: number;
  readonly #clients: Client[] = [];
  /** Tasks run one at a time. */
  #queue: Promise<unknown> = Promise.resolve();
  #timer: ReturnType<typeof setTimeout> | undefined;
  #isDisposed = false;

  /** @param start gives a worker's client; workers start when they are first needed */
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
        return await task(this.#team(present(await about), { signal }));
      } finally {
        if (!this.#isDisposed) this.#timer = setTimeout(() => this.rest(), IDLE_MS);
      }
    });
    const forget = (): void => undefined;
    this.#queue = result.then(forget, forget);
    return untilAborted(result, signal);
  }

  /** Ends the workers until they are needed again. */
  rest(): void {
    clearTimeout(this.#timer);
    for (const client of this.#clients) client.rest();
  }

  /** Ends the workers for good. */
  dispose(): void {
    this.#isDisposed = true;
    clearTimeout(this.#timer);
    for (const client of this.#clients) client.dispose();
  }

  #team(subject: Subject, watch: Signal): Team {
    const workers = workersFor(subject, this.#most);
    const about = Promise.resolve(subject);
    const client = (place: number): Client => (this.#clients[place] ??= this.#start());
    return {
      ask: (question) => client(0).ask(about, watch, question),
      async share(parts, question, take) {
        let next = 0;
        let isFailed = false;
        const work = async (mine: Client): Promise<void> => {
          while (!isFailed && next < parts.length) {
            const index = next++;
            const part = parts[index] as (typeof parts)[number];
            const answer = await mine.ask(about, watch, (remote) => question(remote, part));
            if (!isFailed) take(answer, index);
          }
        };
        const working = Array.from({ length: Math.min(workers, parts.length) }, (_, place) => work(client(place)));
        try {
          await Promise.all(working);
        } catch (error) {
          isFailed = true;
          throw error;
        }
      },
    };
  }
}
