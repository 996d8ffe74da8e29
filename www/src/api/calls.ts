/**
 * Serialises calls to a worker, and replaces the worker after a cancel or a crash.
 *
 * WebAssembly cannot be interrupted, so cancelling terminates the worker, and the next call starts another. The client restores the state
 * that a fresh worker needs.
 */
import { isAbort, ofCore, said, SlicerError } from "./error.js";
import { callback, release } from "./callbacks.js";
import type { OnProgress, Remote } from "./wire.js";

export type { Remote };

/** Worker as a {@link Client} uses it; tests pass a fake. */
export interface WorkerHandle {
  remote: Remote;
  /** Ends the worker at once, whatever it is doing. */
  terminate(): void;
  /** Calls back if the worker breaks outside a call, such as when its script cannot be loaded. */
  onBroken(callback: (message: string) => void): void;
}

/** Progress and cancellation of a call. */
export interface Watch {
  /** Aborts the call within 0.1 s at any stage; the previous model and plan stay. */
  signal?: AbortSignal | undefined;
  onProgress?: OnProgress | undefined;
}

/** Ignores progress. */
export const silent: OnProgress = callback(() => undefined);

/** The compiled module, shared by all clients from the moment the first worker starts to compile it. */
export interface Compiled {
  module: Promise<WebAssembly.Module> | null;
  /** URL from which the first worker fetches the module. */
  readonly address: string;
}

/** A running worker. */
export interface Life<Held> {
  readonly handle: WorkerHandle;
  readonly booted: Promise<unknown>;
  /** Settles as `answer` does, but rejects when the worker is terminated, so that no call waits for ever. */
  within<T>(answer: Promise<T>): Promise<T>;
  end(reason: unknown): void;
  /** State that the client believes the worker to hold. */
  readonly held: Held;
}

/** Thrown by a task that must run again in a fresh worker. */
const OUTGROWN = Symbol("outgrown");

/** Worker memory up to this size is not worth a restart. */
const MODEST_BYTES = 256 << 20;

/** Memory that a model may take, as a multiple of its file size; packed files need many times their size. */
const MEMORY_OF_FILE = 64;

/** Returns true if a worker's memory, which never shrinks, is both large and many times what files of this size need. */
async function hasOutgrown({ handle }: Life<unknown>, file_bytes: number): Promise<boolean> {
  return (await handle.remote.memory()) > Math.max(MODEST_BYTES, MEMORY_OF_FILE * file_bytes);
}

/** Restarts the worker and the task if this worker has outgrown the files that replace its models. */
export async function shed(life: Life<unknown>, file_bytes: number): Promise<void> {
  if (await hasOutgrown(life, file_bytes)) throw OUTGROWN;
}

export class Calls<Held> {
  readonly #spawn: () => WorkerHandle;
  readonly #compiled: Compiled;
  readonly #empty: () => Held;
  #life: Life<Held> | null = null;
  /** Calls run one at a time: the core accepts no second call while one is waiting for the GPU. */
  #queue: Promise<unknown> = Promise.resolve();
  #disposed = false;

  /** @param empty creates the state of a fresh worker */
  constructor(spawn: () => WorkerHandle, compiled: Compiled, empty: () => Held) {
    this.#spawn = spawn;
    this.#compiled = compiled;
    this.#empty = empty;
  }

  /**
   * Starts the worker early, then runs `task` once the worker is ready and the page idle, unless other calls come first. The first real
   * call reports a failure.
   */
  async warm(task: (life: Life<Held>) => Promise<unknown>): Promise<void> {
    if (this.#disposed) return;
    const life = this.#live();
    await life.booted.catch(() => undefined);
    const queue = this.#queue;
    await queue;
    await idle();
    if (this.#life === life && this.#queue === queue) await this.run({}, null, task).catch(() => undefined);
  }

  /** Terminates the worker after its pending calls if its memory is large. For a worker whose models are no longer needed. */
  async trim(): Promise<void> {
    if (this.#life === null) return;
    const rest = async (life: Life<Held>): Promise<void> => ((await hasOutgrown(life, 0)) ? this.rest() : undefined);
    await this.run({}, null, rest).catch(() => undefined);
  }

  /** Terminates the worker. The next call starts another. */
  rest(): void {
    this.#life?.end(new DOMException("the slicer was sent to rest", "AbortError"));
  }

  /** Terminates the worker for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#disposed = true;
    this.#life?.end(disposed());
  }

  /** Enqueues a task at once. When its turn comes, it waits for `needed`, then for the worker. */
  run<N, T>(
    watch: Watch,
    needed: Promise<N> | null,
    task: (life: Life<Held>, needed: N, progress: OnProgress) => Promise<T>,
  ): Promise<T> {
    const { signal } = watch;
    // If `needed` rejects early, the call reports it when its turn comes.
    needed?.catch(() => undefined);
    const result = this.#queue.then(async () => {
      signal?.throwIfAborted();
      const needs = (needed === null ? null : await untilAborted(needed, signal)) as N;
      const attempt = (): Promise<T> => this.#attempt(watch, (life, progress) => task(life, needs, progress));
      return attempt().catch((error: unknown) => {
        if (error === OUTGROWN) return attempt();
        throw error;
      });
    });
    // The next call waits for this one to settle. The queue does not hold the result, which may be large.
    const forget = (): void => undefined;
    this.#queue = result.then(forget, forget);
    // A queued call rejects on abort at once, before its turn.
    return untilAborted(result, signal);
  }

  /** Runs a task in the worker. Rejects with {@link OUTGROWN} if it has to run in another. */
  async #attempt<T>({ signal, onProgress }: Watch, task: (life: Life<Held>, progress: OnProgress) => Promise<T>): Promise<T> {
    if (this.#disposed) throw disposed();
    const life = this.#live();
    const abort = (): void => life.end(signal?.reason);
    signal?.addEventListener("abort", abort, { once: true });
    const progress = callback<OnProgress>((stage, fraction, done) => {
      // Ignore progress that arrives after an abort.
      if (signal?.aborted !== true) onProgress?.(stage, fraction, done);
    });
    try {
      return await life.within(life.booted.then(() => task(life, progress)));
    } catch (error) {
      throw this.#understand(error, life, signal);
    } finally {
      signal?.removeEventListener("abort", abort);
      release(progress);
    }
  }

  /** Passes on aborts and the core's own errors. Any other error means that the core crashed, so its worker is terminated. */
  #understand(error: unknown, life: Life<Held>, signal: AbortSignal | undefined): unknown {
    if (isAbort(error, signal)) return error;
    if (error === OUTGROWN) {
      life.end(error);
      return error;
    }
    const described = ofCore(error);
    if (described !== null && described.code !== "start-failed" && described.code !== "crash") return described;
    const broken = described ?? broke("crash", error);
    life.end(broken);
    return broken;
  }

  #live(): Life<Held> {
    if (this.#life !== null) return this.#life;
    const handle = this.#spawn();
    // Not `Promise.race` with one long-lived promise, which would retain every answer, possibly large, until the worker ends.
    const waiting = new Set<(reason: unknown) => void>();
    let ended: { reason: unknown } | null = null;
    const end = (reason: unknown): void => {
      handle.terminate();
      if (this.#life?.handle === handle) this.#life = null;
      ended ??= { reason };
      for (const reject of waiting) reject(ended.reason);
      waiting.clear();
    };
    const within = <T>(answer: Promise<T>): Promise<T> =>
      new Promise((resolve, reject) => {
        if (ended !== null) reject(ended.reason);
        waiting.add(reject);
        answer.then(resolve, reject).finally(() => waiting.delete(reject));
      });
    let started = false;
    handle.onBroken((message) => end(broke(started ? "crash" : "worker-failed", message)));
    const boot = async (): Promise<unknown> => {
      const compiled = this.#compiled;
      while (compiled.module !== null) {
        const module = await compiled.module.catch(() => null);
        if (module !== null) return handle.remote.boot(module);
      }
      compiled.module = within(handle.remote.boot(compiled.address));
      // If this fails, the next worker compiles the module.
      compiled.module.catch(() => (compiled.module = null));
      return compiled.module;
    };
    const booted = boot().then(
      () => {
        started = true;
      },
      (error: unknown) => {
        throw broke("start-failed", error);
      },
    );
    booted.catch(() => undefined);
    this.#life = { handle, booted, within, end, held: this.#empty() };
    return this.#life;
  }
}

/** Settles as `answer` does, or rejects with the signal's reason if that aborts first. */
export function untilAborted<T>(answer: Promise<T>, signal: AbortSignal | undefined): Promise<T> {
  if (signal === undefined) return answer;
  const aborted = new Promise<never>((_, reject) => {
    const abort = (): void => reject(signal.reason as Error);
    if (signal.aborted) abort();
    signal.addEventListener("abort", abort, { once: true });
    const forget = (): void => signal.removeEventListener("abort", abort);
    answer.then(forget, forget);
  });
  return Promise.race([answer, aborted]);
}

/** Resolves when the page is idle; in browsers without `requestIdleCallback`, shortly. */
export const idle = (): Promise<unknown> => new Promise((resolve) => (globalThis.requestIdleCallback ?? setTimeout)(resolve));

export const disposed = (): DOMException => new DOMException("the slicer was disposed of", "AbortError");

/** Error for a worker that failed to start or crashed. */
export function broke(code: "crash" | "start-failed" | "worker-failed", cause: unknown): SlicerError {
  const system = said(cause);
  return new SlicerError(code, system, { system });
}
