/**
 * The types that cross between a page and the worker.
 *
 * The types of the core are re-exported from the generated package, never copied: a change there is a type error here.
 */
import type { Comparison, Preview, MeshInfo, Metric, Options, Printer, Report, Stage, Tradeoff } from "../../pkg/cusp_slicer.js";
import type { ArrangeError, Candidate, Format, JobOptions, JobReport, Limits, Placement, PlatePrintability, Price, PriceItem, Prices, Printability, ReadOptions, SearchOptions, Task } from "../../pkg/cusp_slicer.js";

export type { Comparison, Preview, MeshInfo, Metric, Options, Printer, Report, Stage, Tradeoff };
export type { ArrangeError, Candidate, Format, JobOptions, JobReport, Limits, Placement, PlatePrintability, Price, PriceItem, Prices, Printability, SearchOptions, Task };
export type {
  Arranging,
  Backend,
  Code,
  Count,
  CuspError,
  Drain,
  Exclusion,
  FileKind,
  Finding,
  Finish,
  GpuFault,
  GpuMethod,
  HeightRange,
  Metrics,
  Minimize,
  ModelOptions,
  ModelUnit,
  Peel,
  Planner,
  PartKind,
  PlateChoice,
  PlannerReport,
  BestUniform,
  ModelPrintability,
  ModelReport,
  PriceKind,
  PriceLine,
  Quantity,
  QuantityBreak,
  ReadOptions,
  Resin,
  Severities,
  Severity,
  Snap,
  StlExpected,
  SupportPoint,
  SupportStrength,
  ThreeMfFeature,
  TradeoffPoint,
  UniformLayers,
  Unit,
  Verdict,
  Warning,
  Work,
  XmlFault,
} from "../../pkg/cusp_slicer.js";

/** A printer that is known by name. Its description is complete, except for `machine` and `file_version`, which few have. */
export type KnownPrinter = Printer & Required<Omit<Printer, "machine" | "file_version">>;

/** Called as a stage advances: `fraction` is 0 to 1 within the stage, `done` within the whole task. */
export type OnProgress = (stage: Stage, fraction: number, done: number) => void;

/** A report, and the profile that the plan was made from. */
export interface Profiled<R> {
  report: R;
  /**
   * Bin i covers (i·bin, (i+1)·bin] mm; its value is an error density, or for the volume deviation the area of the
   * section in mm².
   */
  profile: Float32Array;
}

/** Additions to models, in their order: for each, vertex positions for a copy that stands in the middle and is not turned, nine numbers a facet, mm from the plate. */
export interface Shells {
  /** Supports; absent if no model has any. */
  supports?: Float32Array[];
  /** The walls of voids; absent if all models are solid. */
  voids?: Float32Array[];
}

/** A print file of the core's own, and its report. */
export interface Written {
  blob: Blob;
  report: Report;
}

/** The reports of all plates, and the profile of each plate. */
export interface ProfiledPlates extends Shells {
  report: JobReport;
  profiles: Float32Array[];
}

/** The result of a task: a candidate for each of its directions, in their order, as {@link PackedCandidates}. */
export interface TaskResult {
  number: number;
  candidates: PackedCandidates;
}

/** Candidates as the core packs them: see `candidates.ts`. */
export type PackedCandidates = Float64Array;

/** The result of a search. */
export interface SearchResult {
  /** One for each direction, rated. */
  candidates: Candidate[];
  /** The best candidates that differ from each other, best first; at most three. */
  best: Candidate[];
}

/** The state of a search. */
export interface SearchStep {
  /** Tasks for any worker; empty while the next ones depend on outstanding results. */
  tasks: Task[];
  /** The number of directions measured so far. */
  measured: number;
  /** 0 to 1. */
  progress: number;
  /** One per direction; null if no rating was requested. */
  rated: PackedCandidates | null;
  /** Null until the search is done. */
  result: { candidates: PackedCandidates; best: PackedCandidates } | null;
}

/** Has another worker encode a group of layers; null if it failed. */
export type Help = (format: Format, canvas: Uint32Array, runs: Uint32Array) => Promise<Uint8Array | null>;

/** A model that was read; with the corners of its facets, if they are wanted. */
export interface Opened {
  info: MeshInfo;
  positions?: Float32Array;
}

/** Calls of a worker. Models are counted from 0 in their order, and so are plates. */
export interface SlicerWorker {
  /** Starts the core from its compiled module, or from its address. Returns the module for the next worker. */
  boot(module: WebAssembly.Module | string): Promise<WebAssembly.Module>;
  /** The core's memory in bytes, which never shrinks. */
  memory(): number;
  /** Plans a small ring and forgets it: what a browser has not compiled yet, it compiles now. */
  rehearse(): Promise<void>;
  /** Reads a model and adds it after the others; `wantsPositions`: with the corners of its facets. */
  add(file: Blob, reading: ReadOptions, progress: OnProgress, wantsPositions?: boolean): Promise<Opened>;
  remove(model: number): void;
  plan(options: JobOptions, progress: OnProgress): Promise<ProfiledPlates>;
  arrange(options: JobOptions): Placement[];
  problems(options: JobOptions): ArrangeError[];
  /** The best plans of a plate for `points` tolerances. */
  tradeoff(plate: number, options: JobOptions, points: number, progress: OnProgress): Promise<Tradeoff>;
  compare(plate: number, options: JobOptions, progress: OnProgress): Promise<Comparison>;
  /** Findings on a plate of the last plan. */
  inspect(plate: number, limits: Limits, progress: OnProgress): PlatePrintability;
  /** One bit per pixel, rows from the top, most significant bit first, ⌈width / 8⌉ bytes per row. */
  mask(plate: number, layer: number): Uint8Array;
  /** The print file of a plate of the last plan as a Blob. With `take`, passes its chunks there instead, and returns null. As many `helpers` encode some of its layers. */
  archive(plate: number, progress: OnProgress, take: ((chunk: Uint8Array) => void) | null, helpers: number, help: Help): Blob | null | Promise<Blob | null>;
  /** Encodes a group of layers for another worker. Needs no model. */
  encodeGroup(format: Format, canvas: Uint32Array, runs: Uint32Array): Uint8Array;
  /** A binary STL of a plug for each drain hole of a model in the last plan. */
  plugs(model: number): Uint8Array;
  positions(model: number): Float32Array;
  preview(model: number, options: Options): Profiled<Preview>;
  /** How much each facet stands out, 0 to 1. */
  saliency(model: number, progress: OnProgress): Float32Array;
  /** Sets how much each facet matters to later plans and previews, 0 to 1; null: all equally. */
  setWeights(model: number, weights: Float32Array | null): void;
  weightsFile(model: number, weights: Float32Array): Uint8Array;
  readWeights(model: number, file: Blob): Promise<Float32Array>;
  /**
   * Starts a search, which this worker holds until the next one; `measured` are the candidates of an earlier search to reuse.
   * Returns its directions: unit vectors in the file's frame, three numbers each.
   */
  startSearch(model: number, options: Options, search: SearchOptions, measured: PackedCandidates | null): Float64Array;
  /** Delivers results and takes up to `most` new tasks. Rates candidates once `rateFrom` directions are measured. */
  advanceSearch(results: TaskResult[], most: number, rateFrom: number): SearchStep;
  /** Runs tasks of a search that this or another worker holds. */
  evaluate(model: number, options: Options, tasks: Task[]): TaskResult[];
  /** The print file of the test towers; neither the job nor its plan changes. */
  calibrateLayers(options: Options, progress: OnProgress): Promise<Written>;
  printers(): KnownPrinter[];
  /** What an order costs; it needs no model. */
  price(prices: Prices, items: PriceItem[], finish: string | null): Price;
}

/** The worker's interface through comlink, where every method may return a promise. Everything it throws is an `Error` or a plain `CuspError`. */
export type Remote = {
  [Name in keyof SlicerWorker]: (
    ...given: Parameters<SlicerWorker[Name]>
  ) => ReturnType<SlicerWorker[Name]> | Promise<Awaited<ReturnType<SlicerWorker[Name]>>>;
};
