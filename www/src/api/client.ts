/**
 * The client of one model: brings each worker the subject of a call.
 *
 * Each call carries its subject: the model and its facet weights at the time of the call. The last successful plan is kept with
 * its subject and options, and replayed when a fresh worker is asked for its masks.
 */
import * as Comlink from "comlink";
import { Calls, shed, silent, type Compiled, type Life, type Remote, type Watch, type WorkerHandle } from "./calls.js";
import { SlicerError } from "./error.js";
import { priceItems, type Ordered } from "./price.js";
import { told, untold } from "./told.js";
import type { Comparison, Format, Help, KnownPrinter, Limits, OnProgress, Opened, Options, Price, Prices, Printability, Profiled, ReadOptions, Report, Tradeoff, Written } from "./wire.js";

/** What a worker holds: a file as it was read, the weights of its facets, and a plan. */
interface Held {
  file: ModelFile | null;
  weights: Weights;
  /** The plan that the core holds; null if there is none or it is unknown. */
  planned: Planned | null;
}

/** A file and the choices for reading it. One that is read again is another object. */
export interface ModelFile {
  readonly blob: Blob;
  readonly reading: ReadOptions;
}

/** How much each facet matters, 0 to 1; null: all equally. */
export type Weights = Float32Array | null;

/** What a call is about: a model and the weights of its facets. */
export interface Subject {
  readonly name: string;
  readonly file: ModelFile;
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

export class Client {
  readonly #calls: Calls<Held>;
  readonly #helpers: number;
  readonly #help: Help;
  #planned: Planned | null = null;

  /** @param helpers so many workers encode layers of its print files: `help` has one of them do so */
  constructor(spawn: () => WorkerHandle, compiled: Compiled, helpers = 0, help: Help = () => Promise.resolve(null)) {
    this.#helpers = helpers;
    this.#help = help;
    this.#calls = new Calls(spawn, compiled, () => ({ file: null, weights: null, planned: null }));
  }

  /** Starts the worker before it is needed, and has it compile what a plan needs. The first real call reports a failure. */
  warm(): void {
    this.#calls.warm(async ({ handle }) => handle.remote.rehearse()).catch(() => undefined);
  }

  /** Opens a model once its file has arrived. On failure or abort, the previous model stays. */
  open(file: Promise<ModelFile>, watch: Watch, wantsPositions = false): Promise<Opened> {
    return this.#calls.run(watch, file, async (life, file, progress) => {
      const opened = await this.#read(life, file, progress, wantsPositions);
      this.#planned = null;
      return opened;
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
    return this.#calls.run(watch, null, async (life) => {
      const of = await this.#restorePlan(life, silent);
      return { bits: await life.handle.remote.mask(layer), of };
    });
  }

  /** A binary STL of plugs for the drain holes of the last good plan. */
  plugs(watch: Watch): Promise<Uint8Array> {
    return this.#calls.run(watch, null, async (life, _, progress) => {
      await this.#restorePlan(life, progress);
      return life.handle.remote.plugs();
    });
  }

  /** What will fail when the last good plan is printed. */
  inspect(limits: Limits, watch: Watch): Promise<Printability> {
    return this.#calls.run(watch, null, async (life, _, progress) => {
      await this.#restorePlan(life, silent);
      return life.handle.remote.inspect(limits, progress);
    });
  }

  /** The print file of the wanted plan, and that plan. */
  archive(wanted: Wanted, watch: Watch): Promise<{ blob: Blob; of: Planned }> {
    return this.#calls.run(watch, wanted?.about ?? null, async (life, subject, progress) => {
      const of = await this.#planFor(life, subject, wanted?.options, progress);
      const blob = await life.handle.remote.archive(progress, null, this.#helpers, Comlink.proxy(this.#help));
      return { blob: blob ?? new Blob([]), of };
    });
  }

  /** Passes the print file of the wanted plan to `take`, chunk by chunk. The core does not wait for a slow consumer. */
  archiveTo(wanted: Wanted, take: (chunk: Uint8Array) => void, watch: Watch): Promise<void> {
    return this.#calls.run(watch, wanted?.about ?? null, async (life, subject, progress) => {
      await this.#planFor(life, subject, wanted?.options, progress);
      const chunks = told((chunk: Uint8Array) => take(chunk));
      try {
        await life.handle.remote.archive(progress, chunks, this.#helpers, Comlink.proxy(this.#help));
      } finally {
        untold(chunks);
      }
    });
  }

  /** Encodes a group of layers for another worker, whose plan it does not know. */
  encodeGroup(format: Format, canvas: Uint32Array, runs: Uint32Array): Promise<Uint8Array> {
    return this.#calls.run({}, null, async (life) => life.handle.remote.encodeGroup(format, canvas, runs));
  }

  /** Runs a query that depends only on the subject; the last plan and its masks stay. */
  ask<T>(about: About, watch: Watch, question: (remote: Remote, progress: OnProgress) => T | Promise<T>): Promise<T> {
    return this.#about(about, watch, async (life, progress) => question(life.handle.remote, progress));
  }

  /** The print file of the test towers, which needs no subject. */
  calibrateLayers(options: Options, watch: Watch): Promise<Written> {
    return this.#calls.run(watch, null, async (life, _, progress) => life.handle.remote.calibrateLayers(options, progress));
  }

  /** What the last good plan costs. */
  price(prices: Prices, { copies, finish }: Ordered, watch: Watch): Promise<Price> {
    return this.#calls.run(watch, null, async (life) => {
      if (this.#planned === null) throw new SlicerError("no-plan", "plan the layers first");
      return life.handle.remote.price(prices, priceItems(this.#planned.report, copies), finish ?? null);
    });
  }

  printers(): Promise<KnownPrinter[]> {
    return this.#calls.run({}, null, (life) => Promise.resolve(life.handle.remote.printers()));
  }

  /** Gives memory back, once running calls are over, if there is much: the model is needed no more. */
  trim(): void {
    void this.#calls.trim();
  }

  /** Terminates the worker. The next call starts another and restores the model, weights and plan that it needs. */
  rest(): void {
    this.#calls.rest();
  }

  /** Terminates the worker for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#calls.dispose();
  }

  async #plan(life: Life<Held>, subject: Subject, options: Options, progress: OnProgress): Promise<Profiled<Report>> {
    // Until this succeeds, the core's plan is unknown.
    life.held.planned = null;
    const plan = await life.handle.remote.plan(options, progress);
    life.held.planned = this.#planned = { subject, options, report: plan.report };
    return plan;
  }

  /** Opens a file in place of the one that the worker holds. */
  async #read(life: Life<Held>, file: ModelFile, progress: OnProgress, wantsPositions?: boolean): Promise<Opened> {
    await shed(life, file.blob.size);
    const opened = await life.handle.remote.open(file.blob, file.reading, progress, wantsPositions);
    Object.assign(life.held, { file, weights: null, planned: null } satisfies Held);
    return opened;
  }

  /** Opens the subject's file and sets its weights, unless the worker already has them. */
  async #bring(life: Life<Held>, { file, weights }: Subject): Promise<void> {
    if (life.held.file !== file) await this.#read(life, file, silent);
    if (life.held.weights === weights) return;
    await life.handle.remote.setWeights(weights);
    life.held.weights = weights;
  }

  /** Replays the last successful plan, unless the worker already holds it. Throws `no-plan` if there is none. */
  async #restorePlan(life: Life<Held>, progress: OnProgress): Promise<Planned> {
    const planned = this.#planned;
    if (planned === null) throw new SlicerError("no-plan", "plan the layers first");
    if (life.held.planned === planned) return planned;
    await this.#bring(life, planned.subject);
    await life.handle.remote.plan(planned.options, progress);
    life.held.planned = planned;
    return planned;
  }

  /** Plans for these options, unless the last plan is for them; without options, the last plan serves. */
  async #planFor(life: Life<Held>, subject: Subject | null, options: Options | undefined, progress: OnProgress): Promise<Planned> {
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
    task: (life: Life<Held>, progress: OnProgress, subject: Subject) => Promise<T>,
  ): Promise<T> {
    return this.#calls.run(watch, about, async (life, given, progress) => {
      const subject = present(given);
      await this.#bring(life, subject);
      return task(life, progress, subject);
    });
  }
}

/** The subject of a call that needs one. Throws `no-model` if it is null. */
export function present(subject: Subject | null): Subject {
  if (subject === null) throw new SlicerError("no-model", "load a model first");
  return subject;
}
