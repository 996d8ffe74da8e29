/**
 * The page's side of the slicer: one open model, its last good plan, and a worker that can be thrown away.
 *
 * WebAssembly cannot be interrupted, so cancelling terminates the worker. What a fresh one needs is kept here: the
 * compiled module, the file, and the options of the last plan that worked, which are brought back when next needed.
 */
import * as Comlink from "comlink";
import type { CuspError, MeshInfo, OnProgress, Options, Plan, SlicerWorker } from "./wire.js";

/** What {@link SlicerClient} needs of a worker; the tests give a fake. */
export interface Engine {
  remote: Comlink.Remote<SlicerWorker> | SlicerWorker;
  /** Ends the worker at once, whatever it is doing. */
  terminate(): void;
  /** Calls back if the worker breaks outside of any call, such as when its script cannot be loaded. */
  onBroken(callback: (message: string) => void): void;
}

/** How a long call is watched and stopped. */
export interface Watch {
  signal: AbortSignal;
  progress: OnProgress;
}

/** A failure with the core's own code, or one of the page's: `file-unreadable`, `start-failed`, `crash`. */
export class SlicerError extends Error implements CuspError {
  readonly code: string;
  readonly detail: Record<string, unknown> | null;

  constructor({ code, message, detail }: CuspError) {
    super(message);
    this.name = "SlicerError";
    this.code = code;
    this.detail = detail;
  }
}

export function isAbort(error: unknown): boolean {
  return error instanceof DOMException && error.name === "AbortError";
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

/** A live worker: `fate` rejects when it is ended, so that no call on it waits for ever. */
interface Life {
  engine: Engine;
  booted: Promise<unknown>;
  fate: Promise<never>;
  end(reason: unknown): void;
  file: Blob | null;
  options: Options | null;
}

export class SlicerClient {
  readonly #spawn: () => Engine;
  #life: Life | null = null;
  #module: WebAssembly.Module | null = null;
  #file: Blob | null = null;
  #options: Options | null = null;
  /** Calls run one at a time: the core takes no second call while one is waiting for the GPU. */
  #queue: Promise<unknown> = Promise.resolve();

  constructor(spawn: () => Engine = spawnWorker) {
    this.#spawn = spawn;
  }

  /** Starts the worker before it is needed. Failures show in the first real call. */
  warm(): void {
    this.#live().booted.catch(() => undefined);
  }

  /** Opens a model. If that fails or is cancelled, the one before stays. */
  open(file: Blob, watch: Watch): Promise<MeshInfo> {
    return this.#run(watch.signal, async (life) => {
      const info = await life.engine.remote.open(file, Comlink.proxy(watch.progress));
      life.file = this.#file = file;
      life.options = this.#options = null;
      return info;
    });
  }

  /** Plans the open model. If that fails or is cancelled, masks and archive still belong to the plan before. */
  plan(options: Options, watch: Watch): Promise<Plan> {
    return this.#run(watch.signal, async (life) => {
      await this.#restoreFile(life);
      // Until it succeeds nobody knows which plan the core holds.
      life.options = null;
      const plan = await life.engine.remote.plan(options, Comlink.proxy(watch.progress));
      life.options = this.#options = options;
      return plan;
    });
  }

  /** The mask of a layer of the last good plan. */
  mask(layer: number): Promise<Uint8Array> {
    return this.#run(null, async (life) => {
      await this.#restorePlan(life, () => undefined);
      return life.engine.remote.mask(layer);
    });
  }

  /** The zip of the last good plan. */
  archive(watch: Watch): Promise<Uint8Array> {
    return this.#run(watch.signal, async (life) => {
      await this.#restorePlan(life, watch.progress);
      return life.engine.remote.archive(Comlink.proxy(watch.progress));
    });
  }

  dispose(): void {
    this.#life?.end(new DOMException("disposed", "AbortError"));
  }

  async #restoreFile(life: Life): Promise<void> {
    if (this.#file === null) throw new Error("no model is open");
    if (life.file === this.#file) return;
    await life.engine.remote.open(this.#file, Comlink.proxy(() => undefined));
    life.file = this.#file;
  }

  async #restorePlan(life: Life, progress: OnProgress): Promise<void> {
    await this.#restoreFile(life);
    if (this.#options === null) throw new Error("nothing is planned");
    if (life.options === this.#options) return;
    await life.engine.remote.plan(this.#options, Comlink.proxy(progress));
    life.options = this.#options;
  }

  /** Runs `task` when the calls before it are done. Aborting ends the worker only while this very call runs. */
  #run<T>(signal: AbortSignal | null, task: (life: Life) => Promise<T>): Promise<T> {
    const result = this.#queue.then(async () => {
      signal?.throwIfAborted();
      const life = this.#live();
      const abort = (): void => life.end(signal?.reason);
      signal?.addEventListener("abort", abort, { once: true });
      try {
        return await Promise.race([life.booted.then(() => task(life)), life.fate]);
      } catch (error) {
        throw this.#understand(error, life);
      } finally {
        signal?.removeEventListener("abort", abort);
      }
    });
    this.#queue = result.catch(() => undefined);
    return result;
  }

  /** Errors the core describes pass; anything else means that it broke, and a broken core is not asked again. */
  #understand(error: unknown, life: Life): unknown {
    if (isAbort(error)) return error;
    if (!(error instanceof SlicerError) && isCuspError(error)) return new SlicerError(error);
    const broken = error instanceof SlicerError ? error : broke("crash", error);
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
    const booted = engine.remote.boot(this.#module).then(
      (module) => {
        started = true;
        this.#module = module;
      },
      (error: unknown) => {
        throw broke("start-failed", error);
      },
    );
    booted.catch(() => undefined);
    this.#life = { engine, booted, fate, end, file: null, options: null };
    return this.#life;
  }
}

function broke(code: "crash" | "start-failed", cause: unknown): SlicerError {
  return new SlicerError({ code, message: cause instanceof Error ? cause.message : String(cause), detail: null });
}

function isCuspError(value: unknown): value is CuspError {
  return typeof value === "object" && value !== null && !(value instanceof Error) && "code" in value && "message" in value;
}
