/**
 * The client of a plate: brings each worker the models of a call.
 *
 * Each call carries its models, with their weights, as they were when it was made. The last successful plan is kept with its models
 * and options, and replayed when a fresh worker is asked for its masks.
 */
import { Calls, shed, silent, type Compiled, type Life, type Watch, type WorkerHandle } from "./calls.js";
import type { ModelFile, Weights } from "./client.js";
import { SlicerError } from "./error.js";
import { priceItems, type OrderedPlates } from "./price.js";
import type { ArrangeError, Limits, MeshInfo, OnProgress, Placement, PlateOptions, PlatePrintability, PlatesReport, Price, Prices, ProfiledPlates, ReadOptions, Tradeoff } from "./wire.js";

/** A model as a worker is given it. Its number tells it from every other, also from another copy of the same file. */
export interface Loaded {
  readonly id: number;
  readonly name: string;
  readonly file: Blob;
  readonly reading: ReadOptions;
  readonly weights: Weights;
}

/** The models of a call, in order, once earlier calls have settled. */
export type Models = Promise<readonly Loaded[]>;

/** A successful plan with its models and options. */
export interface PlannedPlates {
  readonly models: readonly Loaded[];
  readonly options: PlateOptions;
  readonly report: PlatesReport;
}

/** What a worker holds: models in the order of its plate, and a plan. */
interface Held {
  models: { readonly id: number; weights: Weights }[];
  /** The plan that the core holds; null if there is none or it is unknown. */
  planned: PlannedPlates | null;
}

export class PlateClient {
  readonly #calls: Calls<Held>;
  #planned: PlannedPlates | null = null;

  constructor(spawn: () => WorkerHandle, compiled: Compiled) {
    this.#calls = new Calls(spawn, compiled, () => ({ models: [], planned: null }));
  }

  /** Adds a model to others once its file has arrived. On failure or abort, those stay. */
  add(models: Models, id: number, file: Promise<ModelFile>, watch: Watch): Promise<MeshInfo> {
    return this.#calls.run(watch, Promise.all([models, file]), async (life, [models, file], progress) => {
      await this.#bring(life, models);
      const info = await life.handle.remote.addToPlate(file.blob, file.reading, progress);
      life.held.models.push({ id, weights: null });
      life.held.planned = null;
      return info;
    });
  }

  /** Sends the models' weights to the core now; rejects if it refuses them. */
  bring(models: Models, watch: Watch): Promise<void> {
    return this.#about(models, watch, () => Promise.resolve());
  }

  positions(models: Models, place: (models: readonly Loaded[]) => number, watch: Watch): Promise<Float32Array> {
    return this.#about(models, watch, async (life, models) => life.handle.remote.platePositions(place(models)));
  }

  arrange(models: Models, options: Promise<PlateOptions>, watch: Watch): Promise<Placement[]> {
    return this.#about(models, watch, async (life) => life.handle.remote.arrangePlate(await options));
  }

  problems(models: Models, options: Promise<PlateOptions>, watch: Watch): Promise<ArrangeError[]> {
    return this.#about(models, watch, async (life) => life.handle.remote.plateProblems(await options));
  }

  /** Plans the layers of all plates. On failure or abort, masks and print files still belong to the previous plan. */
  plan(models: Models, options: Promise<PlateOptions>, watch: Watch): Promise<ProfiledPlates> {
    return this.#about(models, watch, async (life, models, progress) => {
      // Until this succeeds, the core's plan is unknown.
      life.held.planned = null;
      const now = await options;
      const plan = await life.handle.remote.planPlate(now, progress);
      life.held.planned = this.#planned = { models, options: now, report: plan.report };
      return plan;
    });
  }

  /** The mask of a layer of a plate of the last good plan, and that plan. */
  mask(plate: number, layer: number, watch: Watch): Promise<{ bits: Uint8Array; of: PlannedPlates }> {
    return this.#calls.run(watch, null, async (life) => {
      const of = await this.#restorePlan(life, silent);
      return { bits: await life.handle.remote.plateMask(plate, layer), of };
    });
  }

  /** The best plans of a plate of the last good plan. */
  tradeoff(plate: number, points: number, watch: Watch): Promise<Tradeoff> {
    return this.#calls.run(watch, null, async (life) => {
      await this.#restorePlan(life, silent);
      return life.handle.remote.tradeoffPlate(plate, points);
    });
  }

  /** The printability of a plate of the last good plan. */
  inspect(plate: number, limits: Limits, watch: Watch): Promise<PlatePrintability> {
    return this.#calls.run(watch, null, async (life, _, progress) => {
      await this.#restorePlan(life, silent);
      return life.handle.remote.inspectPlate(plate, limits, progress);
    });
  }

  /** The print file of a plate of the last good plan, and that plan. */
  archive(plate: number, watch: Watch): Promise<{ blob: Blob; of: PlannedPlates }> {
    return this.#calls.run(watch, null, async (life, _, progress) => {
      const of = await this.#restorePlan(life, progress);
      return { blob: await life.handle.remote.archivePlate(plate, progress), of };
    });
  }

  /** What all copies of the last good plan cost. */
  price(prices: Prices, { finish }: OrderedPlates, watch: Watch): Promise<Price> {
    return this.#calls.run(watch, null, async (life) => {
      if (this.#planned === null) throw new SlicerError("no-plan", "plan the layers first");
      const items = this.#planned.report.plates.flatMap((report) => priceItems(report));
      return life.handle.remote.price(prices, items, finish ?? null);
    });
  }

  /** Gives memory back, once running calls are over, if there is much: no model is needed any more. */
  trim(): void {
    void this.#calls.trim();
  }

  /** Terminates the worker. The next call starts another and restores the models, weights and plan that it needs. */
  rest(): void {
    this.#calls.rest();
  }

  /** Terminates the worker for good: later calls reject with an `AbortError`. */
  dispose(): void {
    this.#calls.dispose();
  }

  /** Removes from the worker's plate what is not among the models, adds what is missing, and sets weights where they differ. */
  async #bring(life: Life<Held>, models: readonly Loaded[]): Promise<void> {
    const { remote } = life.handle;
    const { held } = life;
    const isOver = held.models.some(({ id }, place) => id !== models[place]?.id);
    if (isOver) await shed(life, models.reduce((sum, { file }) => sum + file.size, 0));
    for (let place = 0; place < held.models.length; ) {
      if (held.models[place]?.id === models[place]?.id) place++;
      else {
        held.planned = null;
        await remote.removeFromPlate(place);
        held.models.splice(place, 1);
      }
    }
    for (const { id, file, reading } of models.slice(held.models.length)) {
      held.planned = null;
      await remote.addToPlate(file, reading, silent);
      held.models.push({ id, weights: null });
    }
    for (const [place, { weights }] of models.entries()) {
      const there = held.models[place];
      if (there === undefined || there.weights === weights) continue;
      await remote.setPlateWeights(place, weights);
      there.weights = weights;
    }
  }

  /** Replays the last successful plan, unless the worker already holds it. Throws `no-plan` if there is none. */
  async #restorePlan(life: Life<Held>, progress: OnProgress): Promise<PlannedPlates> {
    const planned = this.#planned;
    if (planned === null) throw new SlicerError("no-plan", "plan the layers first");
    if (life.held.planned === planned) return planned;
    await this.#bring(life, planned.models);
    await life.handle.remote.planPlate(planned.options, progress);
    life.held.planned = planned;
    return planned;
  }

  /** Runs a task on a worker that holds the models. */
  #about<T>(
    models: Models,
    watch: Watch,
    task: (life: Life<Held>, models: readonly Loaded[], progress: OnProgress) => Promise<T>,
  ): Promise<T> {
    return this.#calls.run(watch, models, async (life, models, progress) => {
      await this.#bring(life, models);
      return task(life, models, progress);
    });
  }
}
