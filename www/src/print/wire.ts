/** What crosses between the page and the worker that reads print files. The types of the core are those of its package. */
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
  /** Sides of their pixels in x and y, mm. */
  pixel_mm: readonly [number, number];
  /** The surface of what is printed, coarse enough to look at: nine numbers a facet, mm. Empty if there is too much of it. */
  surface: Float32Array;
  /** The largest preview; null without one that can be read. */
  preview: Picture | null;
}

/** The worker's interface through comlink. It throws plain objects with a code. */
export interface ReaderWorker {
  /** Loads the reader. To be called once, before anything else. */
  start(): Promise<void>;
  /** Opens a print file and decodes all of it. `progress` goes from 0 to 1. */
  read(file: Blob, progress: (fraction: number) => void): Promise<Read>;
  /** One bit per pixel, seen from above, rows from the top, most significant bit first, ⌈width / 8⌉ bytes per row. */
  mask(layer: number): Uint8Array;
}
