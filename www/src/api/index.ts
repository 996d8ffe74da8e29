/**
 * The slicer without a face: models in, plans, masks and print files out. It works in a worker of its own, sends
 * nothing anywhere, and needs neither WebGPU nor cross-origin isolation.
 *
 *     const slicer = createSlicer();
 *     await slicer.load(file);
 *     const { report } = await slicer.plan({ tolerance: 0.05, printer: "saturn-3-ultra" });
 *     const zip = await slicer.export();
 *     slicer.dispose();
 *
 * Lengths are in mm, times in s. Calls are answered one after another. Every call rejects with a `SlicerError`, or with
 * the signal's reason if it was aborted; the model and the plan before it stay. Where there is no browser, as on a server that
 * renders a page, a slicer can be made, and its calls reject with `no-browser`.
 */
import { absentSlicer } from "./absent.js";
import { Lane, spawnWorker, type Compiled, type Engine, type Watch } from "./lane.js";
import { orient, type OrientCall, type Oriented } from "./orient.js";
import { Pool, type Held } from "./pool.js";
import { resolve, type Source } from "./source.js";
import { SlicerError } from "./error.js";
import type { Comparison, Glance, MeshInfo, Options, Printer, Profiled, Report, Search, Tradeoff } from "./wire.js";

export { ERROR_CODES, isAbort, SlicerError, type ErrorCode } from "./error.js";
export type { Source } from "./source.js";
export type { Watch } from "./lane.js";
export type { Found, OrientCall } from "./orient.js";
export type * from "./wire.js";

/** The version of what results look like. It grows when a field goes or changes its meaning, not when one is added. */
export const SCHEMA = 1;

interface Versioned {
  /** See {@link SCHEMA}. */
  schema: typeof SCHEMA;
}

/** A model as it stands in its file. */
export interface Model extends Versioned {
  name: string;
  /** What it was read from, for a page that sends a model along with its plan. */
  file: Blob;
  info: MeshInfo;
}

/** A plan. `report.backend` says what cast the rays, `cpu` or `gpu`; `report.adapter` which GPU. */
export interface Plan extends Versioned, Profiled<Report> {}

/** A plan by the facets alone, for following a model that is being turned. */
export interface GlancedPlan extends Versioned, Profiled<Glance> {}

/** What a search for the best direction found. */
export interface Orientation extends Versioned, Oriented {}

/** The mask of a layer. */
export interface Mask {
  /** From 0, the one on the plate. */
  layer: number;
  /** In pixels. */
  width: number;
  height: number;
  /** One bit a pixel, rows from the top, most significant bit first, ⌈width / 8⌉ bytes a row; 1 is lit. */
  bits: Uint8Array;
}

export interface LoadCall extends Watch {
  /** What the model is called, where the source has no name. */
  name?: string;
}

export interface Slicer {
  /** Reads an STL, binary or text. */
  load(source: Source, call?: LoadCall): Promise<Model>;
  /** Plans the layers of the model. A change of options repeats only what depends on it. */
  plan(options?: Options, call?: Watch): Promise<Plan>;
  /** The mask of a layer of the last plan, from 0. */
  mask(layer: number, call?: Watch): Promise<Mask>;
  /** Best plans for so many tolerances, from the tightest that can be held to the loosest that saves a layer. */
  tradeoff(options?: Options, points?: number, call?: Watch): Promise<Tradeoff & Versioned>;
  /** The plans of all planners side by side. */
  compare(options?: Options, call?: Watch): Promise<Comparison & Versioned>;
  /**
   * The directions that the model is best built in, by layers or time against the quality of the surface. It has workers
   * of its own, so that nothing waits for it; what it finds does not depend on how many. A candidate's `rotation` is for
   * `options.rotation`, and with an `options.height_mm` its `size_mm[2]` is for that.
   */
  orient(options?: Options, search?: Search, call?: OrientCall): Promise<Orientation>;
  /** The print file of the last plan; with options that are not the last plan's, of a plan made for them first. */
  export(options?: Options, call?: Watch): Promise<Blob>;
  /** The same as it is made. The core does not wait for a slow reader: what is not read yet is kept in memory. */
  exportStream(options?: Options, call?: Watch): ReadableStream<Uint8Array>;
  /** Corners of all facets, nine numbers a facet, mm, as the file has them. */
  positions(call?: Watch): Promise<Float32Array>;
  /** A plan by the facets alone: milliseconds, and never behind another call but one of these two. */
  glance(options?: Options, call?: Watch): Promise<GlancedPlan>;
  /** How much each facet stands out, 0 to 1, in the order of `positions()`. Takes about a second for 80,000 facets. */
  saliency(call?: Watch): Promise<Float32Array>;
  /**
   * How much each facet matters, 0 to 1 in the order of `positions()`, to all that is asked from now on; null: all alike.
   * The tolerance holds where that is 1 and is loosened elsewhere, never more than `options.weight_min` allows. Weights
   * are copied, and belong to the model that is open. Resolves once they are taken.
   */
  paint(weights: Float32Array | null, call?: Watch): Promise<void>;
  /** A small file of weights that is bound to the model. */
  weightsFile(weights: Float32Array, call?: Watch): Promise<Blob>;
  /** The weights of such a file, which must be of the model that is open; `paint` makes them count. */
  readWeights(file: Source, call?: Watch): Promise<Float32Array>;
  /** Printers known by name, for `options.printer`. */
  printers(): Promise<Printer[]>;
  /** Starts the worker before it is needed. */
  warm(): void;
  /** Ends the workers until the next call, which brings model and plan back; calls under way reject with an `AbortError`. */
  rest(): void;
  /** Ends the workers for good; calls under way reject with an `AbortError`. */
  dispose(): void;
}

export interface Setup {
  /** Makes a worker; for tests, and for pages that serve `worker.js` in a way of their own. */
  spawn?: () => Engine;
  /** How many workers a search for directions may have at most; as many as there are cores if absent. */
  workers?: number;
}

/** How many points a trade-off curve has if nothing else is said. */
const CURVE_POINTS = 40;

/** Where the number of cores is not told. */
const FEW_WORKERS = 2;

export function createSlicer({ spawn = spawnWorker, workers = globalThis.navigator?.hardwareConcurrency ?? FEW_WORKERS }: Setup = {}): Slicer {
  if (spawn === spawnWorker && globalThis.Worker === undefined) return absentSlicer();
  const compiled: Compiled = { module: null };
  const main = new Lane(spawn, compiled);
  // Live figures must not wait for a plan that takes seconds: they have a worker, which starts when first asked.
  const side = new Lane(spawn, compiled);
  const pool = new Pool(() => new Lane(spawn, compiled), workers);
  let held: Omit<Held, "weights"> | null = null;
  let last: Plan | null = null;

  const plan: Slicer["plan"] = async (options = {}, call = {}) => {
    const made = await main.plan(options, call);
    return (last = { schema: SCHEMA, ...made });
  };

  /** Makes the plan that a print file is asked for, unless it is the last one. */
  const ensure = async (options: Options | undefined, call: Watch): Promise<void> => {
    if (options === undefined) return;
    if (main.isRepainted || JSON.stringify(options) !== JSON.stringify(main.options)) await plan(options, call);
  };

  return {
    async load(source, { name, ...call } = {}) {
      const named = await resolve(source, call.signal);
      const info = await main.open(named.file, call);
      side.take(named.file);
      held = { file: named.file, facets: info.facets };
      last = null;
      return { schema: SCHEMA, name: name ?? named.name, file: named.file, info };
    },
    plan,
    async mask(layer, call = {}) {
      const bits = await main.mask(layer, call);
      if (last === null) throw new SlicerError("no-plan", "plan the layers first");
      const { width, height } = last.report.mask;
      return { layer, width, height, bits };
    },
    async tradeoff(options = {}, points = CURVE_POINTS, call = {}) {
      return { schema: SCHEMA, ...(await main.tradeoff(options, points, call)) };
    },
    async compare(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await main.compare(options, call)) };
    },
    async orient(options = {}, search = {}, call = {}) {
      if (held === null) throw new SlicerError("no-model", "open a model first");
      return { schema: SCHEMA, ...(await orient(pool, { ...held, weights: main.weights }, options, search, call)) };
    },
    async export(options, call = {}) {
      await ensure(options, call);
      return main.archive(call);
    },
    exportStream(options, call = {}) {
      const gone = new AbortController();
      const signal = call.signal === undefined ? gone.signal : AbortSignal.any([call.signal, gone.signal]);
      const watch = { ...call, signal };
      return new ReadableStream<Uint8Array>({
        async start(controller) {
          try {
            await ensure(options, watch);
            // Chunks that were on their way when nobody wanted them any more go nowhere.
            const take = (chunk: Uint8Array): void => {
              if (!signal.aborted) controller.enqueue(chunk);
            };
            await main.archiveTo(take, watch);
            controller.close();
          } catch (error) {
            if (!gone.signal.aborted) controller.error(error);
          }
        },
        cancel: () => gone.abort(),
      });
    },
    positions: (call = {}) => side.positions(call),
    async glance(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await side.glance(options, call)) };
    },
    saliency: (call = {}) => side.saliency(call),
    paint(weights, call = {}) {
      main.weights = side.weights = weights?.slice() ?? null;
      return main.paint(call);
    },
    async weightsFile(weights, call = {}) {
      return new Blob([(await side.weightsFile(weights, call)) as Uint8Array<ArrayBuffer>]);
    },
    async readWeights(file, call = {}) {
      return side.readWeights((await resolve(file, call.signal)).file, call);
    },
    printers: () => main.printers(),
    warm: () => main.warm(),
    rest() {
      main.rest();
      side.rest();
      pool.rest();
    },
    dispose() {
      main.dispose();
      side.dispose();
      pool.dispose();
    },
  };
}
