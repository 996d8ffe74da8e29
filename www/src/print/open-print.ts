/** Opens and decodes a print file in its own worker. */
import * as Comlink from "comlink";
import { SlicerError } from "../api/error.js";
import type { Mask } from "../api/index.js";
import { partError } from "../element/parts/part.js";
import { listenTo, callback, release } from "../api/callbacks.js";
import type { PrintFileError, Read, ReaderWorker } from "./wire.js";

/** Errors raised outside the reader. */
export type ReadError = { code: "file-unreadable" } | { code: "crash"; detail: { system: string } };

/** An open print file. */
export interface Print extends Read {
  name: string;
  /** The mask of a layer, counted from 0; null if it is damaged. */
  mask(layer: number): Promise<Mask | null>;
  /** Ends the worker. */
  close(): void;
}

/**
 * Reads a print file of any known format.
 *
 * @throws PrintFileError | ReadError; a SlicerError if the reader cannot be loaded; the signal's reason if it aborts
 */
export async function openPrint(file: File, signal: AbortSignal, progress: (fraction: number) => void): Promise<Print> {
  const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: "cusp-reader" });
  listenTo(worker);
  const heard = callback((fraction: number) => progress(fraction));
  const remote = Comlink.wrap<ReaderWorker>(worker);
  const broken = new Promise<never>((_, reject) => {
    worker.addEventListener("error", ({ message }) => reject(crash(message)));
    signal.addEventListener("abort", () => reject(signal.reason as Error), { once: true });
  });
  try {
    signal.throwIfAborted();
    await Promise.race([remote.start(), broken]).catch((cause: unknown) => {
      throw signal.aborted ? cause : partError("reader", cause);
    });
    const read = await Promise.race([remote.read(file, heard), broken]);
    const [width, height] = read.pixels;
    const mask = async (layer: number): Promise<Mask | null> => {
      const bits = await Promise.resolve(remote.mask(layer)).catch(() => null);
      return bits === null ? null : { layer, width, height, bits };
    };
    return { ...read, name: file.name, mask, close: () => worker.terminate() };
  } catch (error) {
    worker.terminate();
    throw isCoded(error) || error instanceof SlicerError || signal.aborted ? error : crash(error instanceof Error ? error.message : String(error));
  } finally {
    release(heard);
  }
}

function crash(system: string): ReadError {
  return { code: "crash", detail: { system } };
}

/** Returns true if the reader, or this file, describes the error by a code. */
export function isCoded(error: unknown): error is PrintFileError | ReadError {
  return typeof error === "object" && error !== null && !(error instanceof Error) && "code" in error;
}
