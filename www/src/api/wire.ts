/**
 * What crosses between the page and the worker, and the defaults both sides assume.
 *
 * The types of the core are re-exported from the generated package, never copied: a change there is a type error here.
 */
import type { CuspError, MeshInfo, Metric, Options, Report, Stage } from "../../pkg/cusp_slicer.js";

export type { CuspError, MeshInfo, Metric, Options, Report, Stage };
export type { Backend, Minimize, Planner, PlannerReport, Snap, Warning } from "../../pkg/cusp_slicer.js";

/** Told as a stage advances; `fraction` is 0 to 1 within the stage. */
export type OnProgress = (stage: Stage, fraction: number) => void;

/**
 * A finished plan: the report, and the profile of its metric and source. Bin i covers (i·bin, (i+1)·bin] mm; its value is
 * an error density, or for the volume deviation the area of the section in mm².
 */
export interface Plan {
  report: Report;
  profile: Float32Array;
}

/** What the worker offers through comlink. Everything it throws is an `Error` or a plain `CuspError`. */
export interface SlicerWorker {
  /** Starts the core. `null` compiles it; the compiled module comes back so that the next worker need not. */
  boot(module: WebAssembly.Module | null): Promise<WebAssembly.Module>;
  /** Reads a model. The one that was open stays open if this fails. */
  open(file: Blob, progress: OnProgress): Promise<MeshInfo>;
  plan(options: Options, progress: OnProgress): Promise<Plan>;
  /** One bit a pixel, rows from the top, most significant bit first, ⌈width / 8⌉ bytes a row. */
  mask(layer: number): Uint8Array;
  /** A finished zip. */
  archive(progress: OnProgress): Uint8Array;
}

/** The core's own defaults, which the form shows before anything is changed. */
export const DEFAULTS = {
  rays: 2048,
  layer_min_mm: 0.05,
  layer_max_mm: 0.15,
  /** In the metric's unit: mm, mm, a part of one, mm³. The core allows more for volume where a model needs more. */
  tolerance: { cusp: 0.065, roughness: 0.1, area: 0.1, volume: 1 } satisfies Record<Metric, number>,
  bin_mm: 0.002,
  metric: "cusp",
  minimize: "layers",
  snap: "auto",
} as const;
