/** A plan with its options, and the part of it that is drawn. */
import type { Plan } from "../../api/index.js";
import type { Metric, ModelReport, Options, Preview, Report } from "../../api/wire.js";

/** A plan with its options. */
export interface Result extends Plan {
  options: Options;
  /** The selected model in the plan; undefined if it is on no plate. */
  own: Partial<ModelReport> | undefined;
  /** Minimum and maximum layer thickness, mm: the ends of the colour scale. */
  limits: readonly [number, number];
}

/** Data for charts and the view, from the last plan, or from a preview while the model is being turned or painted. */
export interface Shown {
  metric: Metric;
  /** Value of each bin: see `Plan`. */
  profile: Float32Array;
  bin_mm: number;
  /** Layer boundaries from 0 to the height of the model, mm. */
  z_mm: readonly number[];
  thickness_mm: readonly number[];
  /** Thicknesses at the ends of the colour scale, mm. */
  limits: readonly [number, number];
  /** Ranges of heights in which undersides stay out of tolerance, mm. */
  off_mm: readonly (readonly [number, number])[];
  layers: number;
  print_time_s: number;
  /** Height of the model above the plate, mm. */
  lift_mm: number;
  /** Vertex positions of the supports, nine numbers per facet, in mm with z from the plate; null if there are none. */
  supports: Float32Array | null;
  /** Vertex positions of the walls of the void, likewise; null for a solid model. */
  voids: Float32Array | null;
}

/** Height of the model without the lift below it, mm. */
export function ownHeight(report: Report): number {
  return report.height_mm - liftOf(report);
}

/** Lift of the models of a plate by supports, mm. */
const liftOf = ({ models }: Report): number => Math.max(0, ...models.map(({ supported }) => supported?.lift_mm ?? 0));

/** Geometry added to a model. */
interface Added {
  readonly supports?: Float32Array | undefined;
  readonly voids?: Float32Array | undefined;
}

export function shownOf(report: Report | Preview, profile: Float32Array, added: Added | null = null): Shown {
  const lift_mm = "lift_mm" in report ? report.lift_mm : liftOf(report);
  const { metric, bin_mm, z_mm, thickness_mm, layers, print_time_s, layer_range_mm: limits } = report;
  const off_mm = ("print_through" in report ? report.print_through?.off_mm : null) ?? [];
  return { metric, bin_mm, z_mm, thickness_mm, off_mm, layers, print_time_s, profile, limits, lift_mm, supports: filled(added?.supports), voids: filled(added?.voids) };
}

const filled = (positions: Float32Array | undefined): Float32Array | null => (positions === undefined || positions.length === 0 ? null : positions);

/** Returns true if two sets of options, with their keys in the same order, describe the same plan. */
export function areSame(a: Options | null, b: Options | null): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}
