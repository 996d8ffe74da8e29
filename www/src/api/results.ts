/** What calls of the headless slicer result in, whether they are about a model or a plate. */
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
  /** The name to save it under: that of the model and `-cusp`, or what it is, and its extension, as in `cup-cusp.uvj`. */
  name: string;
  /** Its media type: `application/zip`, or `application/octet-stream` if the format has an extension of its own. */
  type: string;
  blob: Blob;
  /** The warnings of its plan. */
  warnings: Warning[];
}

/** A print file under a name without its extension. */
export function printFile(stem: string, blob: Blob, report: Report): PrintFile {
  const { extension, media_type: type } = report.print_file;
  return { schema: SCHEMA, name: `${stem}.${extension}`, type, blob: blob.slice(0, blob.size, type), warnings: warningsOf(report) };
}

/** The warnings about the models of a plate, then those about the plate. */
export function warningsOf({ models, warnings }: Report): Warning[] {
  return [...models.flatMap((model) => model.warnings), ...warnings];
}
