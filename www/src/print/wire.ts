/** Types that cross between the page and the worker that reads print files. Types of the core are those of its package. */
import type { Inspection } from "../../pkg/cusp_reader.js";

export type { FileFinding, Inspection, LayerInspection, PrintFileError } from "../../pkg/cusp_reader.js";

/** A picture for the printer's screen. */
export interface Picture {
  width: number;
  height: number;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

/** A print file that was read. */
export interface Read {
  inspection: Inspection;
  /** Columns and rows of the masks, seen from above. */
  pixels: readonly [number, number];
  /** Pixel size in x and y, mm. */
  pixel_mm: readonly [number, number];
  /** Surface of the printed model at a coarse resolution for display: nine numbers per facet, mm. Empty if it would be too large. */
  surface: Float32Array;
  /** The largest readable preview; null if there is none. */
  preview: Picture | null;
}

/** The worker's interface through comlink. It throws plain objects with a code. */
export interface ReaderWorker {
  /** Loads the reader. Must be called once, first. */
  start(): Promise<void>;
  /** Opens a print file and decodes all of it. `progress` runs from 0 to 1. */
  read(file: Blob, progress: (fraction: number) => void): Promise<Read>;
  /** One bit per pixel, seen from above, rows from the top, most significant bit first, ⌈width / 8⌉ bytes per row. */
  mask(layer: number): Uint8Array;
}
