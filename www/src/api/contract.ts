/** What the core is about to offer, until the generated package has it. */
import type { Format, Metric, Options as CoreOptions, Slicer as CoreSlicer, Stage } from "../../pkg/cusp_slicer.js";

export interface Glance {
  layers: number;
  height_mm: number;
  size_mm: [number, number, number];
  z_mm: number[];
  thickness_mm: number[];
  print_time_s: number;
  max_error: number;
  metric: Metric;
  bin_mm: number;
}

export interface PrinterInfo {
  name: string;
  model: string;
  pixels: [number, number];
  pitch_um: [number, number];
  volume_mm: [number, number, number];
  layer_mm: [number, number];
  is_mirrored: boolean;
  format: Format;
  step_mm?: number;
}

export interface Options extends CoreOptions {
  rotation?: [number, number, number, number];
  antialias?: 1 | 2 | 4 | 8;
}

type OnProgress = (stage: Stage, fraction: number) => void;

export interface Contract {
  positions?(): Float32Array;
  glance?(options: Options): { report: Glance };
  glance_profile?(): Float32Array;
}

/** The archive in chunks, however the core gives it. */
export function archive(slicer: CoreSlicer, take: (chunk: Uint8Array) => void, progress: OnProgress): void {
  take(slicer.archive(progress));
}
