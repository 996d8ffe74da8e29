/** Result types of the headless slicer, for models and plates. */
import type { Report, Warning } from "./wire.js";

/** The version of the result format. It increases when a field is removed or changes its meaning, not when one is added. */
export const SCHEMA = 3;

/** The default number of points on a trade-off curve. */
export const CURVE_POINTS = 40;

export interface Versioned {
  /** See {@link SCHEMA}. */
  schema: typeof SCHEMA;
}

/** The mask of a layer. */
export interface Mask {
  /** Counted from 0, the layer on the plate. */
  layer: number;
  /** In pixels. */
  width: number;
  height: number;
  /** One bit per pixel, rows from the top, most significant bit first, ⌈width / 8⌉ bytes per row; 1 is lit. */
  bits: Uint8Array;
}

/** A print file. */
export interface PrintFile extends Versioned {
  /** Suggested file name: a stem, usually the name of the model, with `-cusp` and the extension, as in `cup-cusp.uvj`. */
  name: string;
  /** Media type: `application/zip`, or `application/octet-stream` if the format has its own extension. */
  type: string;
  blob: Blob;
  /** Warnings about the plan. */
  warnings: Warning[];
}

/** @param stem name without extension */
export function printFile(stem: string, blob: Blob, report: Report): PrintFile {
  const { extension, media_type: type } = report.print_file;
  return { schema: SCHEMA, name: `${stem}.${extension}`, type, blob: blob.slice(0, blob.size, type), warnings: warningsOf(report) };
}

/** Warnings about the models of a plate, then about the plate. */
export function warningsOf({ models, warnings }: Report): Warning[] {
  return [...models.flatMap((model) => model.warnings), ...warnings];
}
