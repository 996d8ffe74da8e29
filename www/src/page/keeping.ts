/** Whether models are kept between visits: whether the browser can, and whether the person wants it. */
import { readKept, writeKept } from "./storage.js";

/** False in older Safari and on pages without TLS. Some private windows refuse only when asked: see `recentModels()`. */
export const canKeep = (): boolean =>
  "createWritable" in (globalThis.FileSystemFileHandle?.prototype ?? {}) && "locks" in navigator && "getDirectory" in navigator.storage;

export const isKeeping = (): boolean => readKept("models") !== null;

export function setKeeping(is: boolean): void {
  writeKept("models", is ? "kept" : null);
}
