/**
 * The headless slicer: models in, plans, masks and print files out. It runs in its own workers, sends nothing anywhere, and needs neither
 * WebGPU nor cross-origin isolation.
 *
 *     const slicer = createSlicer();
 *     await slicer.load(file);
 *     const { report } = await slicer.plan({ tolerance: 0.05, printer: "saturn-3-ultra" });
 *     const { name, blob } = await slicer.export();
 *     slicer.dispose();
 *
 * Several models, or copies, are one job:
 *
 *     await slicer.load(cup);
 *     await slicer.add(ring, { copies: 20 });
 *     const { plates } = await slicer.plan({ printer: "saturn-3-ultra" });
 *     const { name, blob } = await slicer.export(undefined, { plate: 0 });
 *
 * Lengths are in mm, times in s. Calls are queued in the order in which they are made. A call applies to the models and weights that
 * earlier calls have loaded, added, changed, removed or set, whether or not those calls were awaited. Every call rejects with a
 * `SlicerError`, or with the signal's reason if it was aborted; the previous models and plan stay. Without a browser, as in server-side
 * rendering, a slicer can be created, but its calls reject with `no-browser`.
 */
import { absentSlicer } from "./absent.js";
import { broke, type Compiled, type WorkerHandle, type Watch } from "./calls.js";
import { ALONE, Client, placeOf, type About, type Job, type Loaded as Held, type Weights } from "./client.js";
import { checkWhole, SlicerError } from "./error.js";
import type { OrientCall as Orienting } from "./orient.js";
import type { Helpers } from "./helpers.js";
import { Pool } from "./pool.js";
import type { Ordered } from "./price.js";
import { CURVE_POINTS, printFile, SCHEMA, type Mask, type PrintFile, type Versioned } from "./results.js";
import { resolve, stemOf, type Source } from "./source.js";
import { spawnWorker, wasmAddress, type Assets } from "./spawn.js";
import type { ArrangeError, Arranging, Candidate, Comparison, CureFit, JobOptions, JobReport, KnownPrinter, Limits, MeshInfo, ModelOptions, Options, Placement, PlatePrintability, Preview, Price, Prices, Profiled, ProjectFiles, ProjectPart, ReadOptions, Report, Resin, SearchOptions, SearchResult, Shells, Tradeoff } from "./wire.js";

export { isAbort, SlicerError, type ErrorCode, type ErrorDetails } from "./error.js";
export type { WarningCode, WarningDetails } from "./warning.js";
export type { IndexedFacets, Source } from "./source.js";
export type { Watch } from "./calls.js";
export type { Found } from "./orient.js";
export type { Ordered } from "./price.js";
export { SCHEMA, type Mask, type PrintFile } from "./results.js";
export type * from "./wire.js";

/** A model as read from its file. */
export interface Model extends Versioned {
  /** Identifies the model for the lifetime of the slicer. */
  id: number;
  name: string;
  /** The source file, for a page that uploads a model with its plan. */
  file: Blob;
  /** The reading options used. */
  reading: ReadOptions;
  info: MeshInfo;
  /** Options that override those of the job, and the number of copies. */
  own: ModelOptions;
}

/** Changes to a model's own options; `undefined` reverts to the option of the job. */
export type ModelChange = { [Name in keyof ModelOptions]?: ModelOptions[Name] | undefined };

/**
 * A plan. `report` and `profile` are those of the first plate. In each plate's report, `backend` (`cpu` or `gpu`), `adapter` and
 * `gpu_method` say how the rays were cast.
 */
export interface Plan extends Versioned, Profiled<Report>, Shells {
  /** One per plate. Its report lists its models, the placement of each copy, and each copy's share of time and resin. */
  plates: Profiled<Report>[];
  /** Print time of all plates in succession. */
  print_time_s: number;
  /** Resin volume of all copies. */
  resin_ml: number;
}

/** A plan from the facets alone, for live updates while a model is being rotated. */
export interface PreviewedPlan extends Versioned, Profiled<Preview> {}

/** Findings on a plate, model by model, and the verdict. */
export interface Check extends Versioned, PlatePrintability {}

/** The result of an orientation search. */
export interface OrientationReport extends Versioned, SearchResult {}

/**
 * Print file of two test towers: both have ten layers of 0.05 mm, and one has ten more of 0.1 mm. They print 0.5 and 1.5 mm high on a
 * printer that obeys the thickness of each layer, and 0.5 and 1.0 mm or 1.0 and 2.0 mm on one that applies a single thickness.
 */
export interface TestTowers extends PrintFile {
  /** Report of the towers' plan. */
  report: Report;
}

/** A model just read, with its positions if requested. */
export interface Loaded extends Model {
  /** Corners of all facets, as returned by `positions()`. */
  positions?: Float32Array;
}

export interface LoadCall extends Watch {
  /** The model's name; by default that of the source. */
  name?: string;
  /** Reading options: the plate of a 3MF project, surfaces as models, curved caps. */
  reading?: ReadOptions;
  /** If true, the result has {@link Loaded.positions}, sooner than by a call of `positions()`. */
  positions?: boolean;
}

/** Models, options and places that are kept together. */
export interface Project {
  /** `job` has the options, and places if copies are not arranged again; `models` have the names of the files. */
  part: ProjectPart;
  /** One for each model. */
  files: readonly ProjectFiles[];
}

/** Options of a call about a model. */
export interface ModelCall extends Watch {
  /** `id` of the model; by default the first. */
  model?: number | undefined;
}

/** Options of a call about a plate of the last plan. */
export interface PlateCall extends Watch {
  /** Index of the plate, from 0, the default. */
  plate?: number | undefined;
}

/** Rules for arranging copies, or explicit placements. */
export interface PlanCall extends Watch {
  arranging?: Arranging | undefined;
  /**
   * Placement of each copy: `model` is the model's index in `models()`, from 0. If empty, copies are arranged automatically; a single copy
   * stands in the middle.
   */
  placements?: readonly Placement[] | undefined;
}

export interface OrientCall extends Orienting, ModelCall {}

export interface Slicer {
  /** Reads a model (3MF, OBJ or STL), which replaces all others. */
  load(source: Source, call?: LoadCall): Promise<Loaded>;
  /** Reads a model and appends it to the others. */
  add(source: Source, own?: ModelChange, call?: LoadCall): Promise<Loaded>;
  /** Changes some of a model's own options. Rejects with `plate-no-model` if the model does not exist. */
  update(id: number, own: ModelChange): Promise<Model>;
  /** Removes a model. Rejects with `plate-no-model` if it does not exist. */
  remove(id: number): Promise<void>;
  /** All models, in order. */
  models(): Promise<readonly Model[]>;
  /** Arranges copies on as few plates as possible, then for the lowest height, and returns their placements. */
  arrange(options?: Options, arranging?: Arranging, call?: Watch): Promise<Placement[]>;
  /** Faults of placements: copies that extend beyond their plate, and copies that overlap. */
  problems(options: Options, placements: readonly Placement[], call?: Watch): Promise<ArrangeError[]>;
  /** Plans the layers of all plates. A change of options recomputes only what depends on it. */
  plan(options?: Options, call?: PlanCall): Promise<Plan>;
  /** Mask of a layer of the last plan, counted from 0. */
  mask(layer: number, call?: PlateCall): Promise<Mask>;
  /**
   * Findings on a plate of the last plan, with their places in masks and layers. `limits` are the acceptance limits of a shop; omitted ones
   * have the defaults.
   */
  check(limits?: Limits, call?: PlateCall): Promise<Check>;
  /** Best plans of a plate for `points` tolerances (40 by default), from the tightest feasible to the loosest that still saves a layer. */
  tradeoff(options?: Options, points?: number, call?: PlanCall & PlateCall): Promise<Tradeoff & Versioned>;
  /** Plans of all planners for a plate, side by side. */
  compare(options?: Options, call?: PlanCall & PlateCall): Promise<Comparison & Versioned>;
  /**
   * Searches for the best orientations of a model, weighing layers or print time against surface quality. It runs in separate workers, so
   * no other call waits for it; the result does not depend on the number of workers. To plan for a candidate, set `options.rotation` to its
   * `rotation` and, if the options have a `height_mm`, set that to its `size_mm[2]`.
   */
  orient(options?: Options, search?: SearchOptions, call?: OrientCall): Promise<OrientationReport>;
  /**
   * Measures one direction as a search does, to compare any pose with its candidates. `direction` is the unit vector, in the file's frame,
   * that points up from the plate. The candidate has no `energy`, which is relative to other candidates.
   */
  measure(options: Options, direction: Readonly<Candidate["direction"]>, call?: ModelCall): Promise<Candidate>;
  /** Print file of a plate of the last plan. If `options` are given and the last plan is not for them, plans first. */
  export(options?: Options, call?: PlanCall & PlateCall): Promise<PrintFile>;
  /** Print files of all plates of the last plan, each made when read. */
  exportAll(call?: Watch): ReadableStream<PrintFile>;
  /**
   * The same print file as {@link export}, as a stream of its chunks. The core does not wait for a slow reader:
   * unread chunks stay in memory. Cancelling the stream aborts the call.
   */
  exportStream(options?: Options, call?: PlanCall & PlateCall): ReadableStream<Uint8Array>;
  /**
   * Binary STL with a plug for each drain hole of a model in the last plan, to print and glue in. The plugs stand upright in a row on the
   * plate, as `cusp slice --plugs` writes them. Without drain holes, it has no facets.
   */
  plugs(call?: ModelCall): Promise<Uint8Array>;
  /** Corners of all facets of a model in mm, nine numbers per facet, in the file's frame. */
  positions(call?: ModelCall): Promise<Float32Array>;
  /**
   * Plans a model from its facets alone, within milliseconds. It shares a worker with `positions()`, `saliency()`, `calibrateLayers()` and
   * the calls for weight files, and does not wait for other plans.
   */
  preview(options?: Options, call?: ModelCall): Promise<PreviewedPlan>;
  /** Saliency of each facet, 0 to 1, in the order of `positions()`. Takes about a second for 80,000 facets. */
  saliency(call?: ModelCall): Promise<Float32Array>;
  /**
   * Sets the importance of each facet of a model for all later calls, 0 to 1 in the order of `positions()`; null: all equal. The tolerance
   * holds where the weight is 1 and is looser elsewhere, at most as far as `options.weight_min` allows. The weights are copied. Resolves
   * once the core has accepted them; if it refuses, the previous weights stay.
   */
  setWeights(weights: Float32Array | null, call?: ModelCall): Promise<void>;
  /** Small file of these weights, bound to the model. */
  weightsFile(weights: Float32Array, call?: ModelCall): Promise<Blob>;
  /** Reads the weights from such a file, which must belong to the model; `setWeights()` applies them. */
  readWeights(file: Source, call?: ModelCall): Promise<Float32Array>;
  /**
   * Print file of test towers, which show whether a printer obeys the thickness of each layer. It needs no model, and changes neither the
   * job nor its plan. Uses only the options for printer, screen, format and resin. Rejects with `uniform-only` if the format has one
   * thickness for all layers.
   */
  calibrateLayers(options?: Options, call?: Watch): Promise<TestTowers>;
  /**
   * Print file of bridges of 1, 2, 3, 4, 6 and 8 layers of 0.05 mm in front and of 0.1 mm behind, which measure the print-through of a resin.
   * Likewise it needs no model.
   */
  calibrateCure(options?: Options, call?: Watch): Promise<PrintFile>;
  /**
   * Print-through by the measured thicknesses of these bridges in millimetres, from the left, those in front first; NaN for those that were
   * not measured. `resin` is the one that they were printed with. Null if fewer than four are measured.
   */
  fitCure(measured_mm: readonly number[], resin?: Resin, call?: Watch): Promise<CureFit | null>;
  /**
   * Price of the last plan for the prices of a shop, by the formula in docs/price.md. Each copy counts with its share of its plate's time.
   * `cusp verify --prices` computes the same on a server.
   */
  price(prices: Prices, ordered?: Ordered, call?: Watch): Promise<Price>;
  /** Reads a project, as {@link writeProject} or `cusp plate -o NAME.3mf` writes it; null if the file is none. It changes no model. */
  readProject(source: Source, call?: Watch): Promise<Project | null>;
  /**
   * Writes models with their options and places as a project: a 3MF that also holds the files as they were opened. `cusp` takes it in place
   * of models, and other programs read it as models in their poses, without supports and voids.
   */
  writeProject(project: Project, call?: Watch): Promise<Blob>;
  /** The known printers, whose names `options.printer` accepts. */
  printers(): Promise<KnownPrinter[]>;
  /** Starts the worker early, and has the browser compile the code of a plan once the page is idle. */
  warm(): void;
  /** Terminates the workers: running calls reject with an `AbortError`. The next call restores the models and the plan. */
  rest(): void;
  /** Terminates the workers for good: running and later calls reject with an `AbortError`. */
  dispose(): void;
}

export interface Setup {
  /** @internal Starts a worker; tests pass a fake. */
  spawn?: () => WorkerHandle;
  /** Maximum number of workers for an orientation search or a print file; by default the number of cores. */
  workers?: number;
  /**
   * URL of the folder with the package's `worker.js` and `cusp_slicer_bg.wasm`, relative to the page, for builds that place them where no
   * bundler would. A function is called each time a worker starts.
   */
  assets?: Assets | (() => Assets);
}

/** More helpers would only wait for the worker that produces the masks. */
const MOST_HELPERS = 3;

/** Number of workers if the browser does not report its cores. */
const FEW_WORKERS = 2;

/** Compiled modules by URL, shared by all slicers of a page. */
const MODULES = new Map<string, Compiled["module"]>();

/** Fetches the search for orientations, which few slicers need. */
const fetchSearch = (): Promise<typeof import("./orient.js")> =>
  import("./orient.js").catch((error: unknown) => {
    throw broke("start-failed", error);
  });

export function createSlicer(setup: Setup = {}): Slicer {
  const { assets = null, workers = globalThis.navigator?.hardwareConcurrency ?? FEW_WORKERS } = setup;
  if (setup.spawn === undefined && globalThis.Worker === undefined) return absentSlicer();
  const folder = typeof assets === "function" ? assets : (): Assets => assets;
  const spawn = setup.spawn ?? ((): WorkerHandle => spawnWorker(folder()));
  // Fakes compile nothing, so they share nothing.
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
  /** Loaded with the first print file. */
  let helpers: Promise<Helpers> | null = null;
  const main = new Client(spawn, compiled, most, async (...group) => {
    helpers ??= import("./helpers.js").then(({ Helpers }) => new Helpers(client, most));
    // If the helpers cannot be loaded, the worker encodes all layers itself.
    return (await helpers.catch(() => null))?.encode(...group) ?? null;
  });
  // Previews run in their own worker, started on first use, so that they do not wait for a plan of seconds.
  const side = client();
  const pool = new Pool(client, workers);
  /** The models for a call made now, resolved once earlier calls have settled. */
  let models: Promise<readonly Entry[]> = Promise.resolve([]);
  let added = 0;

  const about = (id: number | undefined): About => models.then((all) => modelOf(all, id));
  const job = (options: Options, { arranging, placements = [] }: PlanCall = {}): Promise<Job> =>
    models.then((models) => {
      if (models.length === 0) throw noModel();
      const own = models.map(({ own }) => own);
      return { models, options: { options, models: own, ...(arranging !== undefined && { arranging }), placements: [...placements] } satisfies JobOptions };
    });
  const wanted = (options: Options | undefined, call: PlanCall): Promise<Job> | null => (options === undefined ? null : job(options, call));

  /** Reads a model and appends it, or lets it replace the others. */
  const read = async (isAlone: boolean, source: Source, own: ModelChange, call: LoadCall): Promise<Loaded> => {
    const { name, reading = {}, positions, ...watch } = call;
    const id = ++added;
    const before = models;
    const named = resolve(source, watch.signal);
    const opened = main.add(isAlone ? null : before, id, named.then(({ file }) => file), reading, watch, positions);
    const entry = Promise.all([named, opened]).then(
      ([it, { info }]): Entry => ({ schema: SCHEMA, id, name: name ?? it.name, file: it.file, reading, info, search_bytes: info.search_bytes, own: merged({}, own), weights: null }),
    );
    models = Promise.all([before, entry]).then(
      ([all, entry]) => (isAlone ? [entry] : [...all, entry]),
      () => before,
    );
    const [model, { info: _, ...more }] = await Promise.all([entry, opened]);
    return { ...seen(model), ...more };
  };

  /** Replaces a model; `null` removes it. */
  const change = (id: number | undefined, changed: (entry: Entry) => Entry | null): Promise<Entry | null> => {
    const before = models;
    const outcome = before.then((all) => {
      const place = placeOf(all, modelOf(all, id).id);
      const entry = changed(all[place] as Entry);
      const rest = all.filter((_, other) => other !== place);
      return { entry, all: entry === null ? rest : all.map((it, other) => (other === place ? entry : it)) };
    });
    models = outcome.then(
      ({ all }) => all,
      () => before,
    );
    return outcome.then(({ entry }) => entry);
  };

  return {
    async load(source, call = {}) {
      const loaded = await read(true, source, {}, call);
      side.trim();
      return loaded;
    },
    add: (source, own = {}, call = {}) => read(false, source, own, call),
    async update(id, own) {
      return seen((await change(id, (entry) => ({ ...entry, own: merged(entry.own, own) }))) as Entry);
    },
    async remove(id) {
      await change(id, () => null);
      if ((await models).length === 0) main.trim();
    },
    models: () => models.then((all) => all.map(seen)),
    arrange: (options = {}, arranging, call = {}) => main.asks(job(options, { arranging }), call, (remote, { options }) => remote.arrange(options)),
    problems: (options, placements, call = {}) => main.asks(job(options, { placements }), call, (remote, { options }) => remote.problems(options)),
    async plan(options = {}, call = {}) {
      const { report, profiles, ...shells } = await main.plan(job(options, call), call);
      const { print_time_s, resin_ml } = report;
      const plates = report.plates.map((report, plate) => ({ report, profile: profiles[plate] ?? new Float32Array(0) }));
      const [first] = plates;
      if (first === undefined) throw new Error("a plan without plates");
      return { schema: SCHEMA, ...first, plates, print_time_s, resin_ml, ...shells };
    },
    async mask(layer, { plate = 0, ...watch } = {}) {
      checkWhole("plate", plate);
      checkWhole("layer", layer);
      const { bits, of } = await main.mask(plate, layer, watch);
      const { width, height } = reportOf(of.report.plates, plate).mask;
      return { layer, width, height, bits };
    },
    async check(limits = {}, { plate = 0, ...watch } = {}) {
      checkWhole("plate", plate);
      return { schema: SCHEMA, ...(await main.inspect(plate, limits, watch)) };
    },
    async tradeoff(options = {}, points = CURVE_POINTS, call = {}) {
      const { plate = 0 } = call;
      checkWhole("plate", plate);
      return { schema: SCHEMA, ...(await main.asks(job(options, call), call, (remote, { options }, progress) => remote.tradeoff(plate, options, points, progress))) };
    },
    async compare(options = {}, call = {}) {
      const { plate = 0 } = call;
      checkWhole("plate", plate);
      return { schema: SCHEMA, ...(await main.asks(job(options, call), call, (remote, { options }, progress) => remote.compare(plate, options, progress))) };
    },
    async orient(options = {}, search = {}, call = {}) {
      const of = about(call.model);
      const [{ orient }] = await Promise.all([fetchSearch(), of]);
      return { schema: SCHEMA, ...(await orient(pool, of, options, search, call)) };
    },
    async measure(options, direction, call = {}) {
      const of = about(call.model);
      const [{ measure }] = await Promise.all([fetchSearch(), of]);
      return measure(pool, of, options, direction, call);
    },
    async export(options, call = {}) {
      const { plate = 0 } = call;
      checkWhole("plate", plate);
      const { blob, of } = await main.archive(plate, wanted(options, call), call);
      return printFile(`${stemOfPlate(plate, of.report.plates, of.models)}-cusp`, blob, reportOf(of.report.plates, plate));
    },
    exportAll(call = {}) {
      const { gone, signal } = leavable(call);
      let plate = 0;
      let first: JobReport | null = null;
      return new ReadableStream<PrintFile>(
        {
          async pull(controller) {
            const { blob, of } = await main.archive(plate, null, { ...call, signal });
            first ??= of.report;
            if (of.report !== first) throw new SlicerError("no-plan", "there is another plan; export all of its plates", null);
            const { plates } = of.report;
            controller.enqueue(printFile(`${stemOfPlate(plate, plates, of.models)}-cusp`, blob, reportOf(plates, plate)));
            if (++plate >= plates.length) controller.close();
          },
          cancel: () => gone.abort(),
        },
        { highWaterMark: 0 },
      );
    },
    exportStream(options, call = {}) {
      const { plate = 0 } = call;
      const { gone, signal } = leavable(call);
      const planned = wanted(options, call);
      return new ReadableStream<Uint8Array>({
        async start(controller) {
          try {
            checkWhole("plate", plate);
            // Drop chunks that arrive after an abort.
            const take = (chunk: Uint8Array): void => {
              if (!signal.aborted) controller.enqueue(chunk);
            };
            await main.archiveTo(plate, planned, take, { ...call, signal });
            controller.close();
          } catch (error) {
            if (!gone.signal.aborted) controller.error(error);
          }
        },
        cancel: () => gone.abort(),
      });
    },
    plugs: ({ model, ...watch } = {}) => main.plugs(about(model).then(({ id }) => id), watch),
    positions: ({ model, ...watch } = {}) => side.ask(about(model), watch, (remote) => remote.positions(ALONE)),
    async preview(options = {}, { model, ...watch } = {}) {
      return { schema: SCHEMA, ...(await side.ask(about(model), watch, (remote) => remote.preview(ALONE, options))) };
    },
    saliency: ({ model, ...watch } = {}) => side.ask(about(model), watch, (remote, progress) => remote.saliency(ALONE, progress)),
    async setWeights(weights, { model, ...watch } = {}) {
      const before = models;
      const own: Weights = weights?.slice() ?? null;
      const changed = change(model, (entry) => ({ ...entry, weights: own }));
      changed.catch(() => undefined);
      const sent = main.bring(models, watch);
      sent.catch(() => undefined);
      const id = (await changed)?.id;
      try {
        await sent;
      } catch (error) {
        // Refused weights do not apply to later calls, whatever else has changed meanwhile.
        const old = (await before).find((entry) => entry.id === id)?.weights ?? null;
        change(id, (entry) => (entry.weights === own ? { ...entry, weights: old } : entry)).catch(() => undefined);
        throw error;
      }
    },
    async weightsFile(weights, { model, ...watch } = {}) {
      const bytes = await side.ask(about(model), watch, (remote) => remote.weightsFile(ALONE, weights));
      return new Blob([bytes as Uint8Array<ArrayBuffer>]);
    },
    readWeights(source, { model, ...watch } = {}) {
      const now = about(model);
      now.catch(() => undefined);
      const named = resolve(source, watch.signal);
      return named.then(({ file }) => side.ask(now, watch, (remote) => remote.readWeights(ALONE, file)));
    },
    async calibrateLayers(options = {}, call = {}) {
      const { blob, report } = await side.calibrateLayers(options, call);
      return { ...printFile(`towers-${printerName(options)}`, blob, report), report };
    },
    async calibrateCure(options = {}, call = {}) {
      const { blob, report } = await side.calibrateCure(options, call);
      return printFile(`bridges-${printerName(options)}`, blob, report);
    },
    fitCure: (measured_mm, resin = {}, call = {}) => side.fitCure(measured_mm, resin, call),
    price: (prices, ordered = {}, call = {}) => main.price(prices, ordered, call),
    async readProject(source, call = {}) {
      const read = await side.readProject(resolve(source, call.signal).then(({ file }) => file), call);
      return read === null ? null : { part: JSON.parse(read.part) as ProjectPart, files: read.files };
    },
    async writeProject({ part, files }, call = {}) {
      return new Blob([(await side.writeProject(part, files, call)) as Uint8Array<ArrayBuffer>], { type: "model/3mf" });
    },
    printers: () => main.printers(),
    warm: () => main.warm(),
    rest() {
      main.rest();
      side.rest();
      void helpers?.then((it) => it.rest(), () => undefined);
      pool.rest();
    },
    dispose() {
      main.dispose();
      side.dispose();
      void helpers?.then((it) => it.dispose(), () => undefined);
      pool.dispose();
    },
  };
}

/** A model with its internal fields. */
type Entry = Held & Model;

/** The public part of a model. */
function seen({ schema, id, name, file, reading, info, own }: Entry): Model {
  return { schema, id, name, file, reading, info, own };
}

/** Merges changes into a model's own options. */
function merged(before: ModelOptions, changed: ModelChange): ModelOptions {
  const all = Object.entries({ ...before, ...changed });
  return Object.fromEntries(all.filter(([, value]) => value !== undefined));
}

/** A model by its id, or the first. */
function modelOf(all: readonly Entry[], id: number | undefined): Entry {
  const model = id === undefined ? all[0] : all[placeOf(all, id)];
  if (model === undefined) throw noModel();
  return model;
}

/** The signal of a call, aborted also by `gone` when the reader of its stream leaves. */
function leavable({ signal }: Watch): { readonly gone: AbortController; readonly signal: AbortSignal } {
  const gone = new AbortController();
  return { gone, signal: signal === undefined ? gone.signal : AbortSignal.any([signal, gone.signal]) };
}

const noModel = (): SlicerError => new SlicerError("no-model", "load a model first");

/** Report of a plate that the core has just served. */
function reportOf(reports: readonly Report[], plate: number): Report {
  const report = reports[plate];
  if (report === undefined) throw new Error(`there is no plate ${plate}`);
  return report;
}

/** Name of the only model, or of the plate. */
function stemOfPlate(plate: number, reports: readonly Report[], models: readonly Held[]): string {
  const [only, ...others] = reportOf(reports, plate).models;
  const isOne = others.length === 0 && reports.length === 1;
  const name = only === undefined ? undefined : models[only.model]?.name;
  return isOne && name !== undefined ? stemOf(name) : `plate-${plate + 1}`;
}

/** Name of the printer, for a file name. */
function printerName({ printer }: Options): string {
  return (typeof printer === "object" ? printer.name : printer) || "cusp";
}
