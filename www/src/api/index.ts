/**
 * The headless slicer: models in, plans, masks and print files out. It runs in workers of its own, sends
 * nothing anywhere, and needs neither WebGPU nor cross-origin isolation.
 *
 *     const slicer = createSlicer();
 *     await slicer.load(file);
 *     const { report } = await slicer.plan({ tolerance: 0.05, printer: "saturn-3-ultra" });
 *     const { name, blob } = await slicer.export();
 *     slicer.dispose();
 *
 * Lengths are in mm, times in s. A call takes its place in the queue when it is made: it uses the model of the last `load()`
 * and the weights of the last `setWeights()` before it, awaited or not. Every call rejects with a `SlicerError`, or with the
 * signal's reason if it was aborted; the previous model and plan stay. Without a browser, as in server-side rendering, a slicer
 * can be created, but its calls reject with `no-browser`.
 */
import { absentSlicer } from "./absent.js";
import type { Compiled, WorkerHandle, Watch } from "./calls.js";
import { Client, type About, type Wanted } from "./client.js";
import { checkWhole } from "./error.js";
import { measure, orient, type OrientCall } from "./orient.js";
import type { Helpers } from "./helpers.js";
import { fetchedPlate } from "./fetched-plate.js";
import type { AddCall, ModelChange, Plate, PlateModel } from "./plate.js";
import { Pool } from "./pool.js";
import type { Ordered } from "./price.js";
import { CURVE_POINTS, printFile, SCHEMA, type Mask, type PrintFile, type Versioned } from "./results.js";
import { resolve, stemOf, type Source } from "./source.js";
import { spawnWorker, wasmAddress, type Assets } from "./spawn.js";
import type { Candidate, Comparison, KnownPrinter, Limits, MeshInfo, Options, Preview, Price, Prices, Printability, Profiled, ReadOptions, Report, SearchOptions, SearchResult, Tradeoff } from "./wire.js";

export { isAbort, SlicerError, type ErrorCode, type ErrorDetails } from "./error.js";
export type { WarningCode, WarningDetails } from "./warning.js";
export type { IndexedFacets, Source } from "./source.js";
export type { Watch } from "./calls.js";
export type { Found, OrientCall } from "./orient.js";
export type { AddCall, ModelChange, Plate, PlateCall, PlateCheck, PlateModel, PlatesPlan } from "./plate.js";
export type { Ordered, OrderedPlates } from "./price.js";
export { SCHEMA, type Mask, type PrintFile } from "./results.js";
export type * from "./wire.js";

/** A model as read from its file. */
export interface Model extends Versioned {
  name: string;
  /** The file that it was read from, for a page that sends a model along with its plan. */
  file: Blob;
  /** The choices with which it was read. */
  reading: ReadOptions;
  info: MeshInfo;
}

/** A plan. `report.backend` says what cast the rays, `cpu` or `gpu`, `report.adapter` which GPU, and `report.gpu_method` how. */
export interface Plan extends Versioned, Profiled<Report> {}

/** A plan from the facets alone, for live updates while a model is being turned. */
export interface PreviewedPlan extends Versioned, Profiled<Preview> {}

/** What will fail when a plan is printed, and the verdict. */
export interface Check extends Versioned, Printability {}

/** The result of an orientation search. */
export interface OrientationReport extends Versioned, SearchResult {}

/**
 * The print file of two towers side by side: both have ten layers of 0.05 mm, and one goes on with ten of 0.1 mm. Printed, they
 * are 0.5 and 1.5 mm high if the printer takes a thickness for each layer; 0.5 and 1.0 mm, or 1.0 and 2.0 mm, if it takes one for all.
 */
export interface TestTowers extends PrintFile {
  /** The report of its plan. */
  report: Report;
}

/** A model that was read, with what was asked for. */
export interface Loaded extends Model {
  /** The corners of all facets, as `positions()` gives them. */
  positions?: Float32Array;
}

export interface LoadCall extends Watch {
  /** The model's name; that of the source if absent. */
  name?: string;
  /** Choices that the file leaves: a plate of a 3MF project, surfaces as models, curved caps. */
  reading?: ReadOptions;
  /** Whether the answer has {@link Loaded.positions}: sooner than by a call of `positions()`. */
  positions?: boolean;
}

export interface Slicer {
  /** Several models in one job. They and the model of {@link load} leave each other alone. */
  readonly plate: Plate;
  /** Adds a model to the plate: `plate.add()`. */
  add(source: Source, own?: ModelChange, call?: AddCall): Promise<PlateModel>;
  /** Reads a model: 3MF, OBJ or STL. */
  load(source: Source, call?: LoadCall): Promise<Loaded>;
  /** Plans the layers of the model. A change of options recomputes only what depends on it. */
  plan(options?: Options, call?: Watch): Promise<Plan>;
  /** The mask of a layer of the last plan, counted from 0. */
  mask(layer: number, call?: Watch): Promise<Mask>;
  /**
   * What will fail when the last plan is printed, and where, on the masks and layers of the plan. `limits` are what a shop accepts;
   * those left out have the defaults.
   */
  check(limits?: Limits, call?: Watch): Promise<Check>;
  /** The best plans for `points` tolerances (40 by default), from the tightest feasible to the loosest that saves a layer. */
  tradeoff(options?: Options, points?: number, call?: Watch): Promise<Tradeoff & Versioned>;
  /** The plans of all planners side by side. */
  compare(options?: Options, call?: Watch): Promise<Comparison & Versioned>;
  /**
   * Searches for the best orientations, weighing layers or print time against surface quality. It runs in workers of its
   * own, so that no other call waits for it; the result does not depend on their number. To plan for a candidate, set
   * `options.rotation` to its `rotation` and, if the options have a `height_mm`, set that to its `size_mm[2]`.
   */
  orient(options?: Options, search?: SearchOptions, call?: OrientCall): Promise<OrientationReport>;
  /**
   * Measures one direction as a search does, so that any pose can be compared with its candidates. `direction` is the unit vector
   * that points up from the plate, in the file's frame. The candidate has no `energy`, which is relative to others.
   */
  measure(options: Options, direction: Readonly<Candidate["direction"]>, call?: Watch): Promise<Candidate>;
  /** The print file of the last plan. With options, that of a plan for those, made first unless it is the last one. */
  export(options?: Options, call?: Watch): Promise<PrintFile>;
  /**
   * The print file of the same plan as {@link export}, as a stream of its chunks. The core does not wait for a slow reader:
   * unread chunks stay in memory. Cancelling the stream aborts the call.
   */
  exportStream(options?: Options, call?: Watch): ReadableStream<Uint8Array>;
  /**
   * A binary STL of a plug for each drain hole of the last plan, upright in a row on the plate, to print and glue in: what
   * `cusp slice --plugs` writes. Without holes it has no facets.
   */
  plugs(call?: Watch): Promise<Uint8Array>;
  /** The corners of all facets in mm, nine numbers per facet, in the file's frame. */
  positions(call?: Watch): Promise<Float32Array>;
  /**
   * A plan from the facets alone, in milliseconds. It shares a worker with `positions()`, `saliency()`, `calibrateLayers()` and
   * the calls for weight files, and does not wait for other plans.
   */
  preview(options?: Options, call?: Watch): Promise<PreviewedPlan>;
  /** How much each facet stands out, 0 to 1, in the order of `positions()`. Takes about a second for 80,000 facets. */
  saliency(call?: Watch): Promise<Float32Array>;
  /**
   * Sets how much each facet matters to all later calls, 0 to 1 in the order of `positions()`; null: all equally. The
   * tolerance holds where the weight is 1 and is looser elsewhere, never more than `options.weight_min` allows. Weights are
   * copied, and belong to the open model. Resolves once the core has accepted them; if it refuses, the previous weights stay.
   */
  setWeights(weights: Float32Array | null, call?: Watch): Promise<void>;
  /** A small file of these weights, bound to the open model. */
  weightsFile(weights: Float32Array, call?: Watch): Promise<Blob>;
  /** Reads the weights of such a file, which must belong to the open model; `setWeights()` applies them. */
  readWeights(file: Source, call?: Watch): Promise<Float32Array>;
  /**
   * The print file of test towers, which tell whether a printer prints layers of several thicknesses. It needs no model, and leaves
   * the open one and its plan alone. Of the options, printer, screen, format and resin count. Rejects with `uniform-only` if the
   * format has one thickness for all layers.
   */
  calibrateLayers(options?: Options, call?: Watch): Promise<TestTowers>;
  /**
   * What the last plan costs by the prices of a shop: docs/price.md defines the formula. The same code on a server computes the same
   * (`cusp verify --prices`).
   */
  price(prices: Prices, ordered?: Ordered, call?: Watch): Promise<Price>;
  /** The known printers, whose names `options.printer` accepts. */
  printers(): Promise<KnownPrinter[]>;
  /** Starts the worker before it is needed, and has the browser compile what a plan needs once the page is idle. */
  warm(): void;
  /** Terminates the workers: running calls reject with an `AbortError`. The next call restores the model and the plan. */
  rest(): void;
  /** Terminates the workers for good: running and later calls reject with an `AbortError`. */
  dispose(): void;
}

export interface Setup {
  /** @internal Starts a worker; tests pass a fake. */
  spawn?: () => WorkerHandle;
  /** The most workers that an orientation search or a print file may use; by default the number of cores. */
  workers?: number;
  /**
   * URL of the folder with the package's `worker.js` and `cusp_slicer_bg.wasm`, relative to the page, for builds that leave them elsewhere than a
   * bundler would. A function is asked whenever a worker starts.
   */
  assets?: Assets | (() => Assets);
}

/** More helpers would wait for the worker that reads the masks of a print file. */
const MOST_HELPERS = 3;

/** The number of workers if the browser does not report its cores. */
const FEW_WORKERS = 2;

/** The modules of all slicers of a page, by their addresses. */
const MODULES = new Map<string, Compiled["module"]>();

export function createSlicer(setup: Setup = {}): Slicer {
  const { assets = null, workers = globalThis.navigator?.hardwareConcurrency ?? FEW_WORKERS } = setup;
  if (setup.spawn === undefined && globalThis.Worker === undefined) return absentSlicer();
  const folder = typeof assets === "function" ? assets : (): Assets => assets;
  const spawn = setup.spawn ?? ((): WorkerHandle => spawnWorker(folder()));
  // Those of fakes are none.
  const modules = setup.spawn === undefined ? MODULES : new Map<string, Compiled["module"]>();
  const compiled: Compiled = {
    get address() {
      return wasmAddress(folder());
    },
    get module() {
      return modules.get(compiled.address) ?? null;
    },
    set module(module) {
      modules.set(compiled.address, module);
    },
  };
  const client = (): Client => new Client(spawn, compiled);
  const most = Math.max(0, Math.min(MOST_HELPERS, workers - 1));
  /** Fetched with the first print file. */
  let helpers: Promise<Helpers> | null = null;
  const main = new Client(spawn, compiled, most, async (...group) => {
    helpers ??= import("./helpers.js").then(({ Helpers }) => new Helpers(client, most));
    // What cannot be fetched leaves all layers to the worker that asked.
    return (await helpers.catch(() => null))?.encode(...group) ?? null;
  });
  // Previews must not wait for a plan that takes seconds: they have a worker of their own, which starts on first use.
  const side = client();
  const pool = new Pool(client, workers);
  const plate = fetchedPlate(async () => (await import("./plate.js")).createPlate(spawn, compiled));
  /** The subject of a call made now, resolved once earlier loads have settled. */
  let about: About = Promise.resolve(null);

  const wanted = (options: Options | undefined): Wanted => (options === undefined ? null : { about, options });

  return {
    plate,
    add: (source, own, call) => plate.add(source, own, call),
    async load(source, { name, positions, reading = {}, ...call } = {}) {
      const before = about;
      const named = resolve(source, call.signal);
      const file = named.then(({ file: blob }) => ({ blob, reading }));
      const opened = main.open(file, call, positions);
      const loaded = Promise.all([named, opened]).then(([it, opened]) => ({ ...it, name: name ?? it.name, reading, ...opened }));
      about = Promise.all([file, loaded]).then(
        ([file, { name, info }]) => ({ name, file, search_bytes: info.search_bytes, weights: null }),
        () => before,
      );
      const result = { schema: SCHEMA, ...(await loaded) } as const;
      side.trim();
      return result;
    },
    async plan(options = {}, call = {}) {
      return { schema: SCHEMA, ...(await main.plan(about, options, call)) };
    },
    async mask(layer, call = {}) {
      checkWhole("layer", layer);
      const { bits, of } = await main.mask(layer, call);
      const { width, height } = of.report.mask;
      return { layer, width, height, bits };
    },
    async check(limits = {}, call = {}) {
      return { schema: SCHEMA, ...(await main.inspect(limits, call)) };
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
    measure: (options, direction, call = {}) => measure(pool, about, options, direction, call),
    async export(options, call = {}) {
      const { blob, of } = await main.archive(wanted(options), call);
      return printFile(`${stemOf(of.subject.name)}-cusp`, blob, of.report);
    },
    exportStream(options, call = {}) {
      const gone = new AbortController();
      const signal = call.signal === undefined ? gone.signal : AbortSignal.any([call.signal, gone.signal]);
      return new ReadableStream<Uint8Array>({
        async start(controller) {
          try {
            // Drop chunks that arrive after an abort.
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
    plugs: (call = {}) => main.plugs(call),
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
        // Refused weights do not apply to later calls.
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
    async calibrateLayers(options = {}, call = {}) {
      const { blob, report } = await side.calibrateLayers(options, call);
      return { ...printFile(`towers-${printerName(options)}`, blob, report), report };
    },
    price: (prices, ordered = {}, call = {}) => main.price(prices, ordered, call),
    printers: () => main.printers(),
    warm: () => main.warm(),
    rest() {
      main.rest();
      side.rest();
      void helpers?.then((it) => it.rest(), () => undefined);
      plate.rest();
      pool.rest();
    },
    dispose() {
      main.dispose();
      side.dispose();
      void helpers?.then((it) => it.dispose(), () => undefined);
      plate.dispose();
      pool.dispose();
    },
  };
}

/** The name of the printer that the options have, for the name of a file. */
function printerName({ printer }: Options): string {
  return (typeof printer === "object" ? printer.name : printer) || "cusp";
}
