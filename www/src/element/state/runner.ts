/** Runs at most one task at a time, and reports its progress and outcome. */
import { isAbort } from "../../api/error.js";
import type { Watch } from "../../api/index.js";
import type { Options } from "../../api/wire.js";
import { advanced, type Busy } from "../parts/progress.js";

export interface RunnerHost {
  changed(): void;
  progressed(busy: Busy): void;
}

export interface Task {
  readonly kind: Busy["task"];
  /** Name of its model, for display. */
  readonly name: string;
  /** The options of a plan; null for other tasks. */
  readonly options: Options | null;
  readonly weights: Float32Array | null;
}

export class Runner {
  /** The progress of the task; null if none runs. */
  busy: Busy | null = null;
  readonly #host: RunnerHost;
  #running: { readonly task: Task; readonly abort: AbortController } | null = null;

  constructor(host: RunnerHost) {
    this.#host = host;
  }

  get task(): Task | null {
    return this.#running?.task ?? null;
  }

  /** Runs a task and resolves with the call's value; null if it failed, was dropped, or another task started meanwhile. */
  async run<T>(task: Task, failed: (error: unknown) => void, call: (watch: Watch) => Promise<T>): Promise<T | null> {
    const { kind, name } = task;
    const mine = { task, abort: new AbortController() };
    this.#running = mine;
    const stage = kind === "export" || kind === "towers" ? "masks" : "load";
    let busy: Busy = { task: kind, name, stage, fraction: 0, done: 0, started_ms: performance.now() };
    this.busy = busy;
    this.#host.changed();
    const onProgress: Watch["onProgress"] = (stage, fraction, done) => {
      if (this.#running !== mine) return;
      busy = advanced(busy, { stage, fraction, done }, performance.now());
      this.busy = busy;
      this.#host.progressed(busy);
      this.#host.changed();
    };
    try {
      const value = await call({ signal: mine.abort.signal, onProgress });
      // Another task may have started before the value arrived.
      return this.#running === mine ? value : null;
    } catch (error) {
      if (this.#running === mine && !isAbort(error)) failed(error);
      return null;
    } finally {
      if (this.#running === mine) {
        this.#running = null;
        this.busy = null;
        this.#host.changed();
      }
    }
  }

  /** Aborts the running task. */
  drop(): void {
    const running = this.#running;
    this.#running = null;
    this.busy = null;
    running?.abort.abort();
  }
}
