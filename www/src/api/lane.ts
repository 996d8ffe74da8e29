/**
 * One worker after another, as one: what was opened and planned last, brought back after a worker had to be ended.
 *
 * WebAssembly cannot be interrupted, so cancelling terminates the worker. What a fresh one needs is kept here: the
 * compiled module, the file, the weights of its facets, and the last plan that worked: its options and weights. They are brought
 * back when next needed.
 */
import * as Comlink from "comlink";
import { isAbort, ofCore, SlicerError } from "./error.js";
import { sameRays, type Comparison, type Glance, type MeshInfo, type OnProgress, type Options } from "./wire.js";
import type { Printer, Profiled, Report, SlicerWorker, Tradeoff } from "./wire.js";

/** A worker as it is seen from this side: what it answers at once there takes its time here. */
export type Remote = {
  [Name in keyof SlicerWorker]: (
    ...given: Parameters<SlicerWorker[Name]>
  ) => ReturnType<SlicerWorker[Name]> | Promise<Awaited<ReturnType<SlicerWorker[Name]>>>;
};

/** What a {@link Lane} needs of a worker; the tests give a fake. */
export interface Engine {
  remote: Remote;
  /** Ends the worker at once, whatever it is doing. */
  terminate(): void;
  /** Calls back if the worker breaks outside of any call, such as when its script cannot be loaded. */
  onBroken(callback: (message: string) => void): void;
}

/** How a call is watched and stopped. */
export interface Watch {
  /** Aborts the call, within a tenth of a second whatever it is doing; what was there before it stays. */
  signal?: AbortSignal | undefined;
  onProgress?: OnProgress | undefined;
}

export function spawnWorker(): Engine {
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

/** Where lanes keep the compiled module, which is the same for all. */
export interface Compiled {
  module: WebAssembly.Module | null;
}

/** A live worker: `fate` rejects when it is ended, so that no call on it waits for ever. */
interface Life {
  engine: Engine;
  booted: Promise<unknown>;
  fate: Promise<never>;
  end(reason: unknown): void;
  file: Blob | null;
  weights: Weights;
  /** What the plan that the core holds was made for; null if nobody knows. */
  planned: Planned | null;
}

/** How much each facet matters, 0 to 1; null: all alike. */
export type Weights = Float32Array | null;

interface Planned {
  options: Options;
  weights: Weights;
}

const silent: OnProgress = () => undefined;

export class Lane {
  readonly #spawn: () => Engine;
  readonly #compiled: Compiled;
  #life: Life | null = null;
  #file: Blob | null = null;
  #planned: Planned | null = null;
  #weights: Weights = null;
  /** The last weights that the core took. */
  #sound: Weights = null;
  /** Calls run one at a time: the core takes no second call while one is waiting for the GPU. */
  #queue: Promise<unknown> = Promise.resolve();
  #disposed = false;

  constructor(spawn: () => Engine = spawnWorker, compiled: Compiled = { module: null }) {
    this.#spawn = spawn;
    this.#compiled = compiled;
  }

  /** The options of the plan that masks and print files are of; null before there is one. */
  get options(): Options | null {
    return this.#planned?.options ?? null;
  }

  /** Whether weights have changed since that plan. */
  get isRepainted(): boolean {
    return this.#planned !== null && this.#planned.weights !== this.#weights;
  }

  /** Starts the worker before it is needed. Failures show in the first real call. */
  warm(): void {
    if (!this.#disposed) this.#live().booted.catch(() => undefined);
  }

  /** Opens a model. If that fails or is cancelled, the one before stays. */
  open(file: Blob, watch: Watch): Promise<MeshInfo> {
    return this.#run(watch, async (life, progress) => {
      const info = await life.engine.remote.open(file, progress);
      life.file = this.#file = file;
      life.planned = this.#planned = null;
      life.weights = this.#weights = this.#sound = null;
      return info;
    });
  }

  /** Takes a file for the one that is open elsewhere; it is read when something is asked of it. */
  take(file: Blob): void {
    this.#file = file;
    this.#planned = null;
    this.#weights = this.#sound = null;
  }

  /**
   * Weights for whatever is asked from now on, kept as they are: whoever gives them does not write to them any more. The
   * core gets the newest when it is next asked for a plan; weights that it refuses make that fail, and are dropped.
   */
  set weights(weights: Weights) {
    this.#weights = weights;
  }

  get weights(): Weights {
    return this.#weights;
  }

  /** Has the core take the weights now, or refuse them. */
  paint(watch: Watch): Promise<void> {
    return this.#run(watch, (life) => this.#restore(life));
  }

  /** Plans the open model. If that fails or is cancelled, masks and archive still belong to the plan before. */
  plan(options: Options, watch: Watch): Promise<Profiled<Report>> {
    return this.#run(watch, async (life, progress) => {
      await this.#restore(life);
      const { weights } = life;
      // Until it succeeds nobody knows which plan the core holds.
      life.planned = null;
      const plan = await life.engine.remote.plan(options, progress);
      life.planned = this.#planned = { options, weights };
      return plan;
    });
  }

  tradeoff(options: Options, points: number, watch: Watch): Promise<Tradeoff> {
    return this.#study(options, watch, (remote, progress) => remote.tradeoff(options, points, progress));
  }

  compare(options: Options, watch: Watch): Promise<Comparison> {
    return this.#study(options, watch, (remote, progress) => remote.compare(options, progress));
  }

  /** The mask of a layer of the last good plan. */
  mask(layer: number, watch: Watch = {}): Promise<Uint8Array> {
    return this.#run(watch, async (life) => {
      await this.#restorePlan(life, silent);
      return life.engine.remote.mask(layer);
    });
  }

  /** The print file of the last good plan. */
  archive(watch: Watch): Promise<Blob> {
    return this.#run(watch, async (life, progress) => {
      await this.#restorePlan(life, progress);
      const blob = await life.engine.remote.archive(progress, null);
      return blob ?? new Blob([]);
    });
  }

  /** The same, chunk by chunk. The core does not wait for a slow taker. */
  archiveTo(take: (chunk: Uint8Array) => void, watch: Watch): Promise<void> {
    return this.#run(watch, async (life, progress) => {
      await this.#restorePlan(life, progress);
      const { port1, port2 } = new MessageChannel();
      const ended = new Promise<void>((resolve) => {
        port1.onmessage = ({ data }: MessageEvent<Uint8Array | null>): void => {
          if (data === null) resolve();
          else take(data);
        };
      });
      try {
        await life.engine.remote.archive(progress, Comlink.transfer(port2, [port2]));
        await Promise.race([ended, life.fate]);
      } finally {
        port1.close();
      }
    });
  }

  positions(watch: Watch): Promise<Float32Array> {
    return this.#run(watch, async (life) => {
      await this.#restoreFile(life);
      return life.engine.remote.positions();
    });
  }

  glance(options: Options, watch: Watch): Promise<Profiled<Glance>> {
    return this.ask(watch, (remote) => remote.glance(options));
  }

  saliency(watch: Watch): Promise<Float32Array> {
    return this.#run(watch, async (life, progress) => {
      await this.#restoreFile(life);
      return life.engine.remote.saliency(progress);
    });
  }

  weightsFile(weights: Float32Array, watch: Watch): Promise<Uint8Array> {
    return this.#run(watch, async (life) => {
      await this.#restoreFile(life);
      return life.engine.remote.weightsFile(weights);
    });
  }

  readWeights(file: Blob, watch: Watch): Promise<Float32Array> {
    return this.#run(watch, async (life) => {
      await this.#restoreFile(life);
      return life.engine.remote.readWeights(file);
    });
  }

  /** Asks what depends on nothing but the open model and its weights, and changes neither. */
  ask<T>(watch: Watch, question: (remote: Remote) => T | Promise<T>): Promise<T> {
    return this.#run(watch, async (life) => {
      await this.#restore(life);
      return question(life.engine.remote);
    });
  }

  printers(): Promise<Printer[]> {
    return this.#run({}, (life) => Promise.resolve(life.engine.remote.printers()));
  }

  /** Ends the worker until the next call, which brings back what was there. */
  rest(): void {
    this.#life?.end(new DOMException("the slicer was sent to rest", "AbortError"));
  }

  /** Ends the worker for good. */
  dispose(): void {
    this.#disposed = true;
    this.#life?.end(disposed());
  }

  /** Looks at other plans; the last one stays, but through other rays the core would have to make it again. */
  #study<T>(
    options: Options,
    watch: Watch,
    ask: (remote: Remote, progress: OnProgress) => Promise<T>,
  ): Promise<T> {
    return this.#run(watch, async (life, progress) => {
      await this.#restore(life);
      if (life.planned !== null && !sameRays(life.planned.options, options)) life.planned = null;
      return ask(life.engine.remote, progress);
    });
  }

  async #restoreFile(life: Life): Promise<void> {
    if (this.#file === null) throw new SlicerError("no-model", "load a model first");
    if (life.file === this.#file) return;
    await life.engine.remote.open(this.#file, Comlink.proxy(silent));
    life.file = this.#file;
    life.weights = null;
    life.planned = null;
  }

  async #give(life: Life, weights: Weights): Promise<void> {
    if (life.weights === weights) return;
    await life.engine.remote.paint(weights);
    life.weights = weights;
  }

  /** The model and the newest weights. */
  async #restore(life: Life): Promise<void> {
    await this.#restoreFile(life);
    const asked = this.#weights;
    try {
      await this.#give(life, asked);
      this.#sound = asked;
    } catch (error) {
      if (this.#weights === asked) this.#weights = this.#sound;
      throw error;
    }
  }

  async #restorePlan(life: Life, progress: OnProgress): Promise<void> {
    await this.#restoreFile(life);
    const planned = this.#planned;
    if (planned === null) throw new SlicerError("no-plan", "plan the layers first");
    if (life.planned === planned) return;
    await this.#give(life, planned.weights);
    await life.engine.remote.plan(planned.options, Comlink.proxy(progress));
    life.planned = planned;
  }

  #run<T>({ signal, onProgress }: Watch, task: (life: Life, progress: OnProgress) => Promise<T>): Promise<T> {
    const result = this.#queue.then(async () => {
      signal?.throwIfAborted();
      if (this.#disposed) throw disposed();
      const life = this.#live();
      const abort = (): void => life.end(signal?.reason);
      signal?.addEventListener("abort", abort, { once: true });
      const progress = Comlink.proxy<OnProgress>((stage, fraction) => {
        // What was on its way when the call was stopped is news no more.
        if (signal?.aborted !== true) onProgress?.(stage, fraction);
      });
      try {
        return await Promise.race([life.booted.then(() => task(life, progress)), life.fate]);
      } catch (error) {
        throw this.#understand(error, life);
      } finally {
        signal?.removeEventListener("abort", abort);
      }
    });
    // The next call waits for the end of this one, not for its answer, which may be large: it is not held here.
    const forget = (): void => undefined;
    this.#queue = result.then(forget, forget);
    // A call that waits for another need not wait to be cancelled.
    return untilAborted(result, signal);
  }

  /** Errors that are described pass; anything else means that the core broke, and a broken core is not asked again. */
  #understand(error: unknown, life: Life): unknown {
    if (isAbort(error)) return error;
    const described = ofCore(error);
    if (described !== null && described.code !== "start-failed" && described.code !== "crash") return described;
    const broken = described ?? broke("crash", error);
    life.end(broken);
    return broken;
  }

  #live(): Life {
    if (this.#life !== null) return this.#life;
    const engine = this.#spawn();
    let end: (reason: unknown) => void = () => undefined;
    const fate = new Promise<never>((_, reject) => {
      end = (reason) => {
        engine.terminate();
        if (this.#life?.engine === engine) this.#life = null;
        reject(reason);
      };
    });
    fate.catch(() => undefined);
    let started = false;
    engine.onBroken((message) => end(broke(started ? "crash" : "start-failed", message)));
    const booted = engine.remote.boot(this.#compiled.module).then(
      (module) => {
        started = true;
        this.#compiled.module = module;
      },
      (error: unknown) => {
        throw broke("start-failed", error);
      },
    );
    booted.catch(() => undefined);
    this.#life = { engine, booted, fate, end, file: null, weights: null, planned: null };
    return this.#life;
  }
}

/** The answer, but for a signal that aborts before it is there. */
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
  return new SlicerError(code, cause instanceof Error ? cause.message : String(cause));
}
