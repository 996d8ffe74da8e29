/**
 * The headless slicer: models in, plans, masks and print files out. It works in a worker of its own, sends
 * nothing anywhere, and needs neither WebGPU nor cross-origin isolation.
 *
 *     const slicer = createSlicer();
 *     await slicer.load(file);
 *     const { report } = await slicer.plan({ tolerance: 0.05, printer: "saturn-3-ultra" });
 *     const { name, blob } = await slicer.export();
 *     slicer.dispose();
 *
 * Lengths are in mm, times in s. A call takes its place when it is made: it is about the model that the last `load()` before it
 * opens, and the weights of the last `setWeights()`, whether or not these were awaited. Every call rejects with a `SlicerError`, or with
 * the signal's reason if it was aborted; the model and the plan before it stay. Where there is no browser, as on a server that
 * renders a page, a slicer can be made, and its calls reject with `no-browser`.
 */
import { absentSlicer } from "./absent.js";
import { Client, spawnWorker, type About, type Compiled, type WorkerHandle, type Planned, type Wanted, type Watch } from "./client.js";
import { orient, type OrientCall } from "./orient.js";
import { Pool } from "./pool.js";
import { resolve, stemOf, type Source } from "./source.js";
import type { Comparison, Preview, MeshInfo, Options, Printer, Profiled, Report, SearchOptions, SearchResult, Tradeoff, Warning } from "./wire.js";

export { isAbort, SlicerError, type ErrorCode, type ErrorDetails } from "./error.js";
export type { WarningCode, WarningDetails } from "./warning.js";
export type { Source } from "./source.js";
export type { Watch } from "./client.js";
export type { Found, OrientCall } from "./orient.js";
export type * from "./wire.js";

/** The version of what results look like. It grows when a field goes or changes its meaning, not when one is added. */
export const SCHEMA = 2;

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
export interface PreviewedPlan extends Versioned, Profiled<Preview> {}

/** What a search for the best direction found. */
export interface OrientationReport extends Versioned, SearchResult {}

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

/** A print file. */
export interface PrintFile extends Versioned {
  /** What to save it as: the model's name with the format's extension. */
  name: string;
  /** Its media type: `application/zip`, or `application/octet-stream` where the extension is the format's own. */
  type: string;
  blob: Blob;
  /** What the user should know of the plan. */
  warnings: Warning[];
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
  orient(options?: Options, search?: SearchOptions, call?: OrientCall): Promise<OrientationReport>;
  /** The print file of the last plan; with options that are not the last plan's, of a plan made for them first. */
  export(options?: Options, call?: Watch): Promise<PrintFile>;
  /** The same as it is made. The core does not wait for a slow reader: what is not read yet is kept in memory. */
  exportStream(options?: Options, call?: Watch): ReadableStream<Uint8Array>;
  /** Corners of all facets, nine numbers a facet, mm, as the file has them. */
  positions(call?: Watch): Promise<Float32Array>;
  /** A plan by the facets alone: milliseconds, and never behind another call but one of these two. */
  preview(options?: Options, call?: Watch): Promise<PreviewedPlan>;
  /** How much each facet stands out, 0 to 1, in the order of `positions()`. Takes about a second for 80,000 facets. */
  saliency(call?: Watch): Promise<Float32Array>;
  /**
   * How much each facet matters, 0 to 1 in the order of `positions()`, to all that is asked from now on; null: all alike.
   * The tolerance holds where that is 1 and is loosened elsewhere, never more than `options.weight_min` allows. Weights
   * are copied, and belong to the model that is open. Resolves once they are taken.
   */
  setWeights(weights: Float32Array | null, call?: Watch): Promise<void>;
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
  /** @internal Makes a worker; tests give a fake. */
  spawn?: () => WorkerHandle;
  /** How many workers a search for directions may have at most; as many as there are cores if absent. */
  workers?: number;
}

/** How many points a trade-off curve has if nothing else is said. */
const CURVE_POINTS = 40;

/** Where the number of cores is not told. */
const FEW_WORKERS = 2;

export function createSlicer(setup: Setup = {}): Slicer {
  const { spawn = spawnWorker, workers = globalThis.navigator?.hardwareConcurrency ?? FEW_WORKERS } = setup;
  if (spawn === spawnWorker && globalThis.Worker === undefined) return absentSlicer();
  const compiled: Compiled = { module: null };
  const main = new Client(spawn, compiled);
  // Live figures must not wait for a plan that takes seconds: they have a worker, which starts when first asked.
  const side = new Client(spawn, compiled);
  const pool = new Pool(() => new Client(spawn, compiled), workers);
  /** What a call that is made now is about, once the loads before it have ended. */
  let about: About = Promise.resolve(null);

  const wanted = (options: Options | undefined): Wanted => (options === undefined ? null : { about, options });

  return {
    async load(source, { name, ...call } = {}) {
      const before = about;
      const named = resolve(source, call.signal);
      const opened = main.open(named.then(({ file }) => file), call);
      const loaded = Promise.all([named, opened]).then(([it, info]) => ({ ...it, name: name ?? it.name, info }));
      about = loaded.then(
        ({ name, file, info }) => ({ name, file, search_bytes: info.search_bytes, weights: null }),
        () => before,
      );
      return { schema: SCHEMA, ...(await loaded) };
    },
    async plan(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await main.plan(about, options, call)) };
    },
    async mask(layer, call = {}) {
      const { bits, of } = await main.mask(layer, call);
      const { width, height } = of.report.mask;
      return { layer, width, height, bits };
    },
    async tradeoff(options = {}, points = CURVE_POINTS, call = {}) {
      return { schema: SCHEMA, ...(await main.tradeoff(about, options, points, call)) };
    },
    async compare(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await main.compare(about, options, call)) };
    },
    async orient(options = {}, search = {}, call = {}) {
      return { schema: SCHEMA, ...(await orient(pool, about, options, search, call)) };
    },
    async export(options, call = {}) {
      const { blob, of } = await main.archive(wanted(options), call);
      return printFile(blob, of);
    },
    exportStream(options, call = {}) {
      const gone = new AbortController();
      const signal = call.signal === undefined ? gone.signal : AbortSignal.any([call.signal, gone.signal]);
      return new ReadableStream<Uint8Array>({
        async start(controller) {
          try {
            // Chunks that were on their way when nobody wanted them any more go nowhere.
            const take = (chunk: Uint8Array): void => {
              if (!signal.aborted) controller.enqueue(chunk);
            };
            await main.archiveTo(wanted(options), take, { ...call, signal });
            controller.close();
          } catch (error) {
            if (!gone.signal.aborted) controller.error(error);
          }
        },
        cancel: () => gone.abort(),
      });
    },
    positions: (call = {}) => side.ask(about, call, (remote) => remote.positions()),
    async preview(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await side.ask(about, call, (remote) => remote.preview(options))) };
    },
    saliency: (call = {}) => side.ask(about, call, (remote, progress) => remote.saliency(progress)),
    setWeights(weights, call = {}) {
      const before = about;
      const own = weights?.slice() ?? null;
      const painted = (about = before.then((subject) => (subject === null ? null : { ...subject, weights: own })));
      const taken = main.setWeights(painted, call);
      taken.catch(() => {
        // Weights that were refused count for nothing that is asked from now on.
        if (about === painted) about = before;
      });
      return taken;
    },
    async weightsFile(weights, call = {}) {
      const bytes = await side.ask(about, call, (remote) => remote.weightsFile(weights));
      return new Blob([bytes as Uint8Array<ArrayBuffer>]);
    },
    readWeights(source, call = {}) {
      const now = about;
      const named = resolve(source, call.signal);
      return named.then(({ file }) => side.ask(now, call, (remote) => remote.readWeights(file)));
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

function printFile(blob: Blob, { subject, report }: Planned): PrintFile {
  const { extension, media_type: type } = report.print_file;
  const name = `${stemOf(subject.name)}-cusp.${extension}`;
  return { schema: SCHEMA, name, type, blob: blob.slice(0, blob.size, type), warnings: report.warnings };
}
