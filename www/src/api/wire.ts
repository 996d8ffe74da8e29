/**
 * What crosses between a page and the worker, and the defaults both sides assume.
 *
 * The types of the core are re-exported from the generated package, never copied: a change there is a type error here.
 */
import type { Comparison, Preview, MeshInfo, Metric, Options, Printer, Report, Stage, Tradeoff } from "../../pkg/cusp_slicer.js";
import type { Candidate, SearchOptions, Task } from "../../pkg/cusp_slicer.js";

export type { Comparison, Preview, MeshInfo, Metric, Options, Printer, Report, Stage, Tradeoff };
export type { Candidate, SearchOptions, Task };
export type {
  Backend,
  CuspError,
  Exclusion,
  FileKind,
  Format,
  GpuFault,
  HeightRange,
  Metrics,
  Minimize,
  Planner,
  PlannerReport,
  Quantity,
  Resin,
  Snap,
  StlExpected,
  TradeoffPoint,
  Unit,
  Warning,
} from "../../pkg/cusp_slicer.js";

/** Told as a stage advances: `fraction` is 0 to 1 within the stage, `done` within the whole task. */
export type OnProgress = (stage: Stage, fraction: number, done: number) => void;

/** A report, and the profile that it was planned by. */
export interface Profiled<R> {
  report: R;
  /**
   * Bin i covers (i·bin, (i+1)·bin] mm; its value is an error density, or for the volume deviation the area of the
   * section in mm².
   */
  profile: Float32Array;
}

/** What was measured for a task: a candidate for each of its directions, in their order. */
export interface TaskResult {
  number: number;
  candidates: Candidate[];
}

/** What a search found. */
export interface SearchResult {
  /** One for each direction, rated. */
  candidates: Candidate[];
  /** The best ones that differ from each other, the best first: three at most. */
  best: Candidate[];
}

/** Where a search is. */
export interface SearchStep {
  /** To be run by any worker; none while they depend on results that are still out. */
  tasks: Task[];
  /** How many directions are measured. */
  measured: number;
  /** 0 to 1. */
  progress: number;
  /** One for each direction, null before it is measured; null if no rating was asked for. */
  rated: (Candidate | null)[] | null;
  /** Null before all is done. */
  result: SearchResult | null;
}

/** What the worker offers through comlink. Everything it throws is an `Error` or a plain `CuspError`. */
export interface SlicerWorker {
  /** Starts the core. `null` compiles it; the compiled module comes back so that the next worker need not. */
  boot(module: WebAssembly.Module | null): Promise<WebAssembly.Module>;
  /** Reads a model. The one that was open stays open if this fails. */
  open(file: Blob, progress: OnProgress): Promise<MeshInfo>;
  plan(options: Options, progress: OnProgress): Promise<Profiled<Report>>;
  tradeoff(options: Options, points: number, progress: OnProgress): Promise<Tradeoff>;
  compare(options: Options, progress: OnProgress): Promise<Comparison>;
  /** One bit a pixel, rows from the top, most significant bit first, ⌈width / 8⌉ bytes a row. */
  mask(layer: number): Uint8Array;
  /** The print file of the last plan: as a Blob, or if there is a port in chunks through that, and null at its end. */
  archive(progress: OnProgress, port: MessagePort | null): Blob | null;
  positions(): Float32Array;
  preview(options: Options): Profiled<Preview>;
  /** How much each facet stands out, 0 to 1. */
  saliency(progress: OnProgress): Float32Array;
  /** How much each facet matters to later plans and previews, 0 to 1; null: all alike. */
  setWeights(weights: Float32Array | null): void;
  weightsFile(weights: Float32Array): Uint8Array;
  readWeights(file: Blob): Promise<Float32Array>;
  /**
   * Starts a search, which this worker holds until the next one, with candidates that were measured before if there are
   * any. Returns its directions: unit vectors in the file's frame, three numbers each.
   */
  startSearch(options: Options, search: SearchOptions, measured: readonly Candidate[] | null): Float64Array;
  /** Hands the search the results of tasks, and takes up to `most` others; rates from so many measured directions on. */
  advanceSearch(results: TaskResult[], most: number, rateFrom: number): SearchStep;
  /** Runs tasks of a search, whichever worker holds that. */
  evaluate(options: Options, tasks: Task[]): TaskResult[];
  printers(): Printer[];
}

/** The core's own defaults, which a form shows before the worker is there. A test holds them against the core. */
export const DEFAULTS = {
  rays: 2048,
  layer_min_mm: 0.05,
  layer_max_mm: 0.15,
  /** In the metric's unit: mm, mm, a part of one, mm³. The core allows more for volume where a model needs more. */
  tolerance: { cusp: 0.065, roughness: 0.1, area: 0.1, volume: 1 } satisfies Record<Metric, number>,
  metric: "cusp",
  minimize: "layers",
  snap: "auto",
  saliency: false,
  weight_min: 0.25,
} as const;

/**
 * Whether two sets of options look at the model through the same rays: then going from one to the other is a matter of
 * milliseconds and not worth interrupting.
 */
export function sameRays(a: Options, b: Options): boolean {
  return (
    a.height_mm === b.height_mm &&
    a.rays === b.rays &&
    a.antialias === b.antialias &&
    a.printer === b.printer &&
    a.pitch_mm === b.pitch_mm &&
    a.pitch_y_mm === b.pitch_y_mm &&
    a.backend === b.backend &&
    String(a.pixels) === String(b.pixels) &&
    String(a.rotation) === String(b.rotation)
  );
}
