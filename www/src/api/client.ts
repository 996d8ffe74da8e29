/**
 * The worker client: presents one worker after another as one, and brings each of them the subject of a call.
 *
 * WebAssembly cannot be interrupted, so cancelling terminates the worker. Each call therefore carries its subject: the model
 * and its facet weights at the time of the call. The last successful plan is kept with its subject and options, and replayed
 * when a fresh worker is asked for its masks.
 */
import * as Comlink from "comlink";
import { isAbort, ofCore, said, SlicerError } from "./error.js";
import type { Comparison, KnownPrinter, MeshInfo, OnProgress, Options, Profiled, Report, SlicerWorker, Tradeoff, Written } from "./wire.js";

/** The worker's interface as seen from this side, where every method may return a promise. */
export type Remote = {
  [Name in keyof SlicerWorker]: (
    ...given: Parameters<SlicerWorker[Name]>
  ) => ReturnType<SlicerWorker[Name]> | Promise<Awaited<ReturnType<SlicerWorker[Name]>>>;
};

/** What a {@link Client} needs of a worker; tests pass a fake. */
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

export function spawnWorker(): WorkerHandle {
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: "cusp-slicer" });
  return {
    remote: Comlink.wrap<SlicerWorker>(worker),
    terminate: () => worker.terminate(),
    onBroken: (callback) => {
      worker.addEventListener("error", (event) => callback(event.message || "the worker could not be started"));
      worker.addEventListener("messageerror", () => callback("a message could not be read"));
    },
  };
}

/** Holds the compiled module, which all clients share. */
export interface Compiled {
  module: WebAssembly.Module | null;
}

/** A running worker. `fate` rejects when the worker is terminated, so that no call waits for ever. */
interface Life {
  handle: WorkerHandle;
  booted: Promise<unknown>;
  fate: Promise<never>;
  end(reason: unknown): void;
  file: Blob | null;
  weights: Weights;
  /** The plan that the core holds; null if there is none or it is unknown. */
  planned: Planned | null;
}

/** How much each facet matters, 0 to 1; null: all equally. */
export type Weights = Float32Array | null;

/** What a call is about: a model and the weights of its facets. */
export interface Subject {
  readonly name: string;
  readonly file: Blob;
  /** Memory in bytes that a search takes in each worker besides the file, as the core reports it. */
  readonly search_bytes: number;
  readonly weights: Weights;
}

/** The subject of a call, resolved once earlier calls have settled; null if no model is loaded. */
export type About = Promise<Subject | null>;

/** A successful plan with its subject and options. */
export interface Planned {
  readonly subject: Subject;
  readonly options: Options;
  readonly report: Report;
}

/** The plan to export: one for these options; null: the last one. */
export type Wanted = { about: About; options: Options } | null;

const silent: OnProgress = () => undefined;

export class Client {
  readonly #spawn: () => WorkerHandle;
  readonly #compiled: Compiled;
  #life: Life | null = null;
  #planned: Planned | null = null;
  /** Calls run one at a time: the core accepts no second call while one is waiting for the GPU. */
  #queue: Promise<unknown> = Promise.resolve();
  #disposed = false;

  constructor(spawn: () => WorkerHandle = spawnWorker, compiled: Compiled = { module: null }) {
    this.#spawn = spawn;
    this.#compiled = compiled;
  }

  /** Starts the worker before it is needed. The first real call reports a failure. */
  warm(): void {
    if (!this.#disposed) this.#live().booted.catch(() => undefined);
  }

  /** Opens a model once its file has arrived. On failure or abort, the previous model stays. */
  open(file: Promise<Blob>, watch: Watch): Promise<MeshInfo> {
    return this.#run(watch, file, async (life, file, progress) => {
      const info = await life.handle.remote.open(file, progress);
      life.file = file;
      life.weights = null;
      life.planned = this.#planned = null;
      return info;
    });
  }

  /** Sends the subject's weights to the core now; rejects if it refuses them. */
  setWeights(about: About, watch: Watch): Promise<void> {
    return this.#about(about, watch, () => Promise.resolve());
  }

  /** Plans the layers. On failure or abort, masks and print file still belong to the previous plan. */
  plan(about: About, options: Options, watch: Watch): Promise<Profiled<Report>> {
    return this.#about(about, watch, (life, progress, subject) => this.#plan(life, subject, options, progress));
  }

  tradeoff(about: About, options: Options, points: number, watch: Watch): Promise<Tradeoff> {
    return this.ask(about, watch, (remote, progress) => remote.tradeoff(options, points, progress));
  }

  compare(about: About, options: Options, watch: Watch): Promise<Comparison> {
    return this.ask(about, watch, (remote, progress) => remote.compare(options, progress));
  }

  /** The mask of a layer of the last good plan, and that plan. */
  mask(layer: number, watch: Watch = {}): Promise<{ bits: Uint8Array; of: Planned }> {
    return this.#run(watch, null, async (life) => {
      const of = await this.#restorePlan(life, silent);
      return { bits: await life.handle.remote.mask(layer), of };
    });
  }

  /** The print file of the wanted plan, and that plan. */
  archive(wanted: Wanted, watch: Watch): Promise<{ blob: Blob; of: Planned }> {
    return this.#run(watch, wanted?.about ?? null, async (life, subject, progress) => {
      const of = await this.#planFor(life, subject, wanted?.options, progress);
      const blob = await life.handle.remote.archive(progress, null);
      return { blob: blob ?? new Blob([]), of };
    });
  }

  /** Passes the print file of the wanted plan to `take`, chunk by chunk. The core does not wait for a slow consumer. */
  archiveTo(wanted: Wanted, take: (chunk: Uint8Array) => void, watch: Watch): Promise<void> {
    return this.#run(watch, wanted?.about ?? null, async (life, subject, progress) => {
      await this.#planFor(life, subject, wanted?.options, progress);
      const { port1, port2 } = new MessageChannel();
      const ended = new Promise<void>((resolve) => {
        port1.onmessage = ({ data }: MessageEvent<Uint8Array | null>): void => {
          if (data === null) resolve();
          else take(data);
        };
      });
      try {
        await life.handle.remote.archive(progress, Comlink.transfer(port2, [port2]));
        await Promise.race([ended, life.fate]);
      } finally {
        port1.close();
      }
    });
  }

  /** Runs a query that depends only on the subject; the last plan and its masks stay. */
  ask<T>(about: About, watch: Watch, question: (remote: Remote, progress: OnProgress) => T | Promise<T>): Promise<T> {
    return this.#about(about, watch, async (life, progress) => question(life.handle.remote, progress));
  }

  /** The print file of the test towers, which needs no subject. */
  calibrateLayers(options: Options, watch: Watch): Promise<Written> {
    return this.#run(watch, null, async (life, _, progress) => life.handle.remote.calibrateLayers(options, progress));
  }

  printers(): Promise<KnownPrinter[]> {
    return this.#run({}, null, (life) => Promise.resolve(life.handle.remote.printers()));
  }

  /** Terminates the worker. The next call starts another and restores the model, weights and plan that it needs. */
  rest(): void {
    this.#life?.end(new DOMException("the slicer was sent to rest", "AbortError"));
  }

  /** Terminates the worker for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#disposed = true;
    this.#life?.end(disposed());
  }

  async #plan(life: Life, subject: Subject, options: Options, progress: OnProgress): Promise<Profiled<Report>> {
    // Until this succeeds, the core's plan is unknown.
    life.planned = null;
    const plan = await life.handle.remote.plan(options, progress);
    life.planned = this.#planned = { subject, options, report: plan.report };
    return plan;
  }

  /** Opens the subject's file and sets its weights, unless the worker already has them. */
  async #bring(life: Life, { file, weights }: Subject): Promise<void> {
    const { remote } = life.handle;
    if (life.file !== file) {
      await remote.open(file, Comlink.proxy(silent));
      life.file = file;
      life.weights = null;
      life.planned = null;
    }
    if (life.weights === weights) return;
    await remote.setWeights(weights);
    life.weights = weights;
  }

  /** Replays the last successful plan, unless the worker already holds it. Throws `no-plan` if there is none. */
  async #restorePlan(life: Life, progress: OnProgress): Promise<Planned> {
    const planned = this.#planned;
    if (planned === null) throw new SlicerError("no-plan", "plan the layers first");
    if (life.planned === planned) return planned;
    await this.#bring(life, planned.subject);
    await life.handle.remote.plan(planned.options, Comlink.proxy(progress));
    life.planned = planned;
    return planned;
  }

  /** Plans for these options, unless the last plan is for them; without options, the last plan serves. */
  async #planFor(life: Life, subject: Subject | null, options: Options | undefined, progress: OnProgress): Promise<Planned> {
    if (options === undefined) return this.#restorePlan(life, progress);
    const now = present(subject);
    const last = this.#planned;
    const isLast = last?.subject.file === now.file && last.subject.weights === now.weights;
    if (isLast && JSON.stringify(last.options) === JSON.stringify(options)) return this.#restorePlan(life, progress);
    await this.#bring(life, now);
    await this.#plan(life, now, options, progress);
    return this.#restorePlan(life, progress);
  }

  /** Runs a task on a worker that holds the subject. */
  #about<T>(
    about: About,
    watch: Watch,
    task: (life: Life, progress: OnProgress, subject: Subject) => Promise<T>,
  ): Promise<T> {
    return this.#run(watch, about, async (life, given, progress) => {
      const subject = present(given);
      await this.#bring(life, subject);
      return task(life, progress, subject);
    });
  }

  /** Enqueues a task at once. When its turn comes, it waits for `needed`, then for the worker. */
  #run<N, T>(
    { signal, onProgress }: Watch,
    needed: Promise<N> | null,
    task: (life: Life, needed: N, progress: OnProgress) => Promise<T>,
  ): Promise<T> {
    // If `needed` rejects early, the call reports it when its turn comes.
    needed?.catch(() => undefined);
    const result = this.#queue.then(async () => {
      signal?.throwIfAborted();
      const needs = (needed === null ? null : await untilAborted(needed, signal)) as N;
      if (this.#disposed) throw disposed();
      const life = this.#live();
      const abort = (): void => life.end(signal?.reason);
      signal?.addEventListener("abort", abort, { once: true });
      const progress = Comlink.proxy<OnProgress>((stage, fraction, done) => {
        // Ignore progress that arrives after an abort.
        if (signal?.aborted !== true) onProgress?.(stage, fraction, done);
      });
      try {
        return await Promise.race([life.booted.then(() => task(life, needs, progress)), life.fate]);
      } catch (error) {
        throw this.#understand(error, life, signal);
      } finally {
        signal?.removeEventListener("abort", abort);
      }
    });
    // The next call waits for this one to settle. The queue does not hold the result, which may be large.
    const forget = (): void => undefined;
    this.#queue = result.then(forget, forget);
    // A queued call rejects on abort at once, before its turn.
    return untilAborted(result, signal);
  }

  /** Passes on aborts and the core's own errors. Anything else means that the core broke, so its worker is terminated. */
  #understand(error: unknown, life: Life, signal: AbortSignal | undefined): unknown {
    if (isAbort(error, signal)) return error;
    const described = ofCore(error);
    if (described !== null && described.code !== "start-failed" && described.code !== "crash") return described;
    const broken = described ?? broke("crash", error);
    life.end(broken);
    return broken;
  }

  #live(): Life {
    if (this.#life !== null) return this.#life;
    const handle = this.#spawn();
    let end: (reason: unknown) => void = () => undefined;
    const fate = new Promise<never>((_, reject) => {
      end = (reason) => {
        handle.terminate();
        if (this.#life?.handle === handle) this.#life = null;
        reject(reason);
      };
    });
    fate.catch(() => undefined);
    let started = false;
    handle.onBroken((message) => end(broke(started ? "crash" : "start-failed", message)));
    const booted = handle.remote.boot(this.#compiled.module).then(
      (module) => {
        started = true;
        this.#compiled.module = module;
      },
      (error: unknown) => {
        throw broke("start-failed", error);
      },
    );
    booted.catch(() => undefined);
    this.#life = { handle, booted, fate, end, file: null, weights: null, planned: null };
    return this.#life;
  }
}

/** The subject of a call that needs one. Throws `no-model` if it is null. */
export function present(subject: Subject | null): Subject {
  if (subject === null) throw new SlicerError("no-model", "load a model first");
  return subject;
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

export const disposed = (): DOMException => new DOMException("the slicer was disposed of", "AbortError");

function broke(code: "crash" | "start-failed", cause: unknown): SlicerError {
  const system = said(cause);
  return new SlicerError(code, system, { system });
}
