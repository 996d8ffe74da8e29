/** A report whose fields tests can override. */
import type { PlannerReport, Report, BestUniform } from "../../api/wire.js";

export const uniform = (layers: number, max_error: number, print_time_s: number): PlannerReport => ({
  planner: "uniform",
  layers,
  max_error,
  print_time_s,
});

/** Uniform layers within the tolerance of the report. */
const within: BestUniform = { layer_mm: 0.065, layers: 923, max_error: 0.065, print_time_s: 10_200 };

export const uniforms = (patch: Partial<Report["uniform"]> = {}): Report["uniform"] => ({
  finest: uniform(1200, 0.05, 13_200),
  coarsest: uniform(400, 0.15, 5_538),
  fewest: within,
  quickest: within,
  is_enough: false,
  ...patch,
});

export function report(patch: Partial<Report>): Report {
  return {
    schema: 3,
    options: {},
    plate: 0,
    plate_count: 1,
    models: [],
    placements: [{ model: 0, plate: 0, x_mm: 0, y_mm: 0, turn_deg: 0 }],
    layers: 793,
    height_mm: 60,
    z_mm: [],
    thickness_mm: [],
    snapped_mm: [],
    metric: "cusp",
    unit: "mm",
    source: "exact",
    tolerance: 0.065,
    max_error: 0.065,
    sampled_error: null,
    true_error: 0.065,
    max_error_mm: 0.065,
    max_deviation_mm: 0.0364,
    print_time_s: 9000,
    planner: "optimal",
    backend: "cpu",
    adapter: null,
    gpu_method: null,
    bins: 30_000,
    bin_mm: 0.002,
    layer_range_mm: [0.05, 0.15],
    uniform: uniforms(),
    exposure_s: [],
    overhead_s: 7.6,
    resin: {},
    resin_ml: 44.4,
    printer: null,
    print_file: { format: "png", extension: "zip", media_type: "application/zip", is_read_by_printer: false },
    mask: { width: 2048, height: 1588, pitch_mm: 0.0293, pitch_y_mm: 0.0293, antialias: 1, is_mirrored: false },
    warnings: [],
    timings_ms: { load: 0, ldi: 0, profile: 0, plan: 0, masks: 0, total: 0 },
    ...patch,
  };
}
