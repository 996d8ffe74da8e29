/**
 * The client of a job: sends each call to a worker that holds the call's models.
 *
 * A call carries the models and facet weights that were current when it was made. The last successful plan is kept with its models and
 * options, and replayed when a fresh worker needs it for masks.
 */
import * as Comlink from "comlink";
import { Calls, shed, silent, type Compiled, type Life, type Remote, type Watch, type WorkerHandle } from "./calls.js";
import { SlicerError } from "./error.js";
import { priceItems, type Ordered } from "./price.js";
import { callback, release } from "./callbacks.js";
import type { CureFit, Format, Help, JobOptions, JobReport, KnownPrinter, Limits, OnProgress, Opened, Options, PlatePrintability, Price, Prices, ProfiledPlates, ProjectFiles, ProjectPart, ReadOptions, ReadProject, Resin, Written } from "./wire.js";

/** Importance of each facet, 0 to 1; null: all equal. */
export type Weights = Float32Array | null;

/** A model as sent to a worker. `id` is unique, also among copies of the same file. */
export interface Loaded {
  readonly id: number;
  readonly name: string;
  readonly file: Blob;
  readonly reading: ReadOptions;
  /** Memory in bytes that a search takes in each worker besides the file, as reported by the core. */
  readonly search_bytes: number;
  readonly weights: Weights;
}

/** The models of a call, in order, once earlier calls have settled. */
export type Models = Promise<readonly Loaded[]>;

/** The model of a call; rejects if there is none. */
export type About = Promise<Loaded>;

/** Models with the options of a job. */
export interface Job {
  readonly models: readonly Loaded[];
  readonly options: JobOptions;
}

/** A successful plan with its models and options. */
export interface Planned extends Job {
  readonly report: JobReport;
}

/** State of a worker: models in the order of its job, and a plan. */
interface Held {
  models: { readonly id: number; weights: Weights }[];
  /** The plan that the core holds; null if none or unknown. */
  planned: Planned | null;
}

/** A query to the core about the first model of the worker's job. */
type Question<T> = (remote: Remote, progress: OnProgress) => T | Promise<T>;

/** Index of the model in a worker that holds only one. */
export const ALONE = 0;

export class Client {
  readonly #calls: Calls<Held>;
  readonly #helpers: number;
  readonly #help: Help;
  #planned: Planned | null = null;

  /** @param helpers number of workers that may encode layers of its print files through `help` */
  constructor(spawn: () => WorkerHandle, compiled: Compiled, helpers = 0, help: Help = () => Promise.resolve(null)) {
    this.#helpers = helpers;
    this.#help = help;
    this.#calls = new Calls(spawn, compiled, () => ({ models: [], planned: null }));
  }

  /** Starts the worker early and has it compile the code of a plan. The first real call reports a failure. */
  warm(): void {
    this.#calls.warm(async ({ handle }) => handle.remote.warmUp()).catch(() => undefined);
  }

  /** Adds a model after `others`, or with `null` replaces all, once its file has arrived. On failure or abort, the previous models stay. */
  add(others: Models | null, id: number, file: Promise<Blob>, reading: ReadOptions, watch: Watch, wantsPositions = false): Promise<Opened> {
    return this.#calls.run(watch, Promise.all([others, file]), async (life, [others, file], progress) => {
      const { handle, held } = life;
      if (others !== null) await this.#bring(life, others);
      else if (held.models.length > 0) await shed(life, file.size);
      const opened = await handle.remote.add(file, reading, progress, wantsPositions);
      held.planned = null;
      // If the new model cannot be read, the others stay.
      if (others === null) for (const _ of held.models.splice(0)) await handle.remote.remove(0);
      held.models.push({ id, weights: null });
      return opened;
    });
  }

  /** Sends the models' weights to the core now; rejects if it refuses them. */
  bring(models: Models, watch: Watch): Promise<void> {
    return this.#calls.run(watch, models, (life, models) => this.#bring(life, models));
  }

  /** Plans the layers of all plates. On failure or abort, masks and print files still belong to the previous plan. */
  plan(job: Promise<Job>, watch: Watch): Promise<ProfiledPlates> {
    return this.#calls.run(watch, job, (life, job, progress) => this.#plan(life, job, progress));
  }

  /** The mask of a layer of a plate of the last good plan, and that plan. */
  mask(plate: number, layer: number, watch: Watch = {}): Promise<{ bits: Uint8Array; of: Planned }> {
    return this.#calls.run(watch, null, async (life) => {
      const of = await this.#restorePlan(life, silent);
      return { bits: await life.handle.remote.mask(plate, layer), of };
    });
  }

  /** A binary STL of plugs for the drain holes of a model in the last good plan. */
  plugs(id: Promise<number>, watch: Watch): Promise<Uint8Array> {
    return this.#calls.run(watch, id, async (life, id, progress) => {
      const { models } = await this.#restorePlan(life, progress);
      return life.handle.remote.plugs(placeOf(models, id));
    });
  }

  /** Findings on a plate of the last good plan. */
  inspect(plate: number, limits: Limits, watch: Watch): Promise<PlatePrintability> {
    return this.#calls.run(watch, null, async (life, _, progress) => {
      await this.#restorePlan(life, silent);
      return life.handle.remote.inspect(plate, limits, progress);
    });
  }

  /** The print file of a plate of the wanted plan, and that plan; null: the last one. */
  archive(plate: number, wanted: Promise<Job> | null, watch: Watch): Promise<{ blob: Blob; of: Planned }> {
    return this.#calls.run(watch, wanted, async (life, job, progress) => {
      const of = await this.#planFor(life, job, progress);
      const blob = await life.handle.remote.archive(plate, progress, null, this.#helpers, Comlink.proxy(this.#help));
      return { blob: blob ?? new Blob([]), of };
    });
  }

  /** Passes that print file to `take`, chunk by chunk. The core does not wait for a slow consumer. */
  archiveTo(plate: number, wanted: Promise<Job> | null, take: (chunk: Uint8Array) => void, watch: Watch): Promise<void> {
    return this.#calls.run(watch, wanted, async (life, job, progress) => {
      await this.#planFor(life, job, progress);
      const chunks = callback((chunk: Uint8Array) => take(chunk));
      try {
        await life.handle.remote.archive(plate, progress, chunks, this.#helpers, Comlink.proxy(this.#help));
      } finally {
        release(chunks);
      }
    });
  }

  /** Encodes a group of layers on behalf of another worker; needs no plan. */
  encodeGroup(format: Format, canvas: Uint32Array, runs: Uint32Array): Promise<Uint8Array> {
    return this.#calls.run({}, null, async (life) => life.handle.remote.encodeGroup(format, canvas, runs));
  }

  /** Runs a query about models that depends on no plan; the last plan and its masks stay. */
  asks<N extends Job | readonly Loaded[], T>(needed: Promise<N>, watch: Watch, question: (remote: Remote, needed: N, progress: OnProgress) => T | Promise<T>): Promise<T> {
    return this.#calls.run(watch, needed, async (life, needed, progress) => {
      await this.#bring(life, "models" in needed ? needed.models : needed);
      return question(life.handle.remote, needed, progress);
    });
  }

  /** Runs such a query about one model, in a worker that holds only that model. */
  ask<T>(about: About, watch: Watch, question: Question<T>): Promise<T> {
    const alone = about.then((model) => [model]);
    return this.asks(alone, watch, (remote, _, progress) => question(remote, progress));
  }

  /** The print file of the test towers, which needs no model. */
  calibrateLayers(options: Options, watch: Watch): Promise<Written> {
    return this.#calls.run(watch, null, async (life, _, progress) => life.handle.remote.calibrateLayers(options, progress));
  }

  /** The print file of the bridges that measure print-through, likewise. */
  calibrateCure(options: Options, watch: Watch): Promise<Written> {
    return this.#calls.run(watch, null, async (life, _, progress) => life.handle.remote.calibrateCure(options, progress));
  }

  fitCure(measured_mm: readonly number[], resin: Resin, watch: Watch): Promise<CureFit | null> {
    return this.#calls.run(watch, null, async (life) => life.handle.remote.fitCure(measured_mm, resin));
  }

  /** Price of the last good plan. */
  price(prices: Prices, { copies, finish }: Ordered, watch: Watch): Promise<Price> {
    return this.#calls.run(watch, null, async (life) => {
      if (this.#planned === null) throw new SlicerError("no-plan", "plan the layers first");
      const items = this.#planned.report.plates.flatMap((report) => priceItems(report, copies));
      return life.handle.remote.price(prices, items, finish ?? null);
    });
  }

  readProject(file: Promise<Blob>, watch: Watch): Promise<ReadProject | null> {
    return this.#calls.run(watch, file, async (life, file) => life.handle.remote.readProject(file));
  }

  writeProject(part: ProjectPart, files: readonly ProjectFiles[], watch: Watch): Promise<Uint8Array> {
    return this.#calls.run(watch, null, async (life) => life.handle.remote.writeProject(part, files));
  }

  printers(): Promise<KnownPrinter[]> {
    return this.#calls.run({}, null, (life) => Promise.resolve(life.handle.remote.printers()));
  }

  /** Frees a large memory after pending calls, once no model is needed any more. */
  trim(): void {
    void this.#calls.trim();
  }

  /** Terminates the worker. The next call starts another and restores the models, weights and plan. */
  rest(): void {
    this.#calls.rest();
  }

  /** Terminates the worker for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#calls.dispose();
  }

  async #plan(life: Life<Held>, { models, options }: Job, progress: OnProgress): Promise<ProfiledPlates> {
    await this.#bring(life, models);
    // The core's plan is unknown until this succeeds.
    life.held.planned = null;
    const plan = await life.handle.remote.plan(options, progress);
    life.held.planned = this.#planned = { models, options, report: plan.report };
    return plan;
  }

  /** Removes models that are not listed, adds missing ones, and sets weights where they differ. */
  async #bring(life: Life<Held>, models: readonly Loaded[]): Promise<void> {
    const { remote } = life.handle;
    const { held } = life;
    const isOver = held.models.some(({ id }, place) => id !== models[place]?.id);
    if (isOver) await shed(life, models.reduce((sum, { file }) => sum + file.size, 0));
    for (let place = 0; place < held.models.length; ) {
      if (held.models[place]?.id === models[place]?.id) place++;
      else {
        held.planned = null;
        await remote.remove(place);
        held.models.splice(place, 1);
      }
    }
    for (const { id, file, reading } of models.slice(held.models.length)) {
      held.planned = null;
      await remote.add(file, reading, silent);
      held.models.push({ id, weights: null });
    }
    for (const [place, { weights }] of models.entries()) {
      const there = held.models[place];
      if (there === undefined || there.weights === weights) continue;
      await remote.setWeights(place, weights);
      there.weights = weights;
    }
  }

  /** Replays the last successful plan, unless the worker already holds it. Throws `no-plan` if there is none. */
  async #restorePlan(life: Life<Held>, progress: OnProgress): Promise<Planned> {
    const planned = this.#planned;
    if (planned === null) throw new SlicerError("no-plan", "plan the layers first");
    if (life.held.planned === planned) return planned;
    await this.#bring(life, planned.models);
    await life.handle.remote.plan(planned.options, progress);
    life.held.planned = planned;
    return planned;
  }

  /** Plans a job unless the last plan was for it. Without a job, restores the last plan. */
  async #planFor(life: Life<Held>, job: Job | null, progress: OnProgress): Promise<Planned> {
    if (job !== null && !this.#isPlanned(job)) await this.#plan(life, job, progress);
    return this.#restorePlan(life, progress);
  }

  #isPlanned({ models, options }: Job): boolean {
    const last = this.#planned;
    const isSame = last?.models.length === models.length && models.every((model, place) => model === last.models[place]);
    return isSame && JSON.stringify(last.options) === JSON.stringify(options);
  }
}

/** Index of a model. Throws `plate-no-model` if there is none with this id. */
export function placeOf(models: readonly Pick<Loaded, "id">[], id: number): number {
  const place = models.findIndex((model) => model.id === id);
  if (place >= 0) return place;
  throw new SlicerError("plate-no-model", `there is no model ${id} on the plate`, { model_number: id, models: models.length });
}
