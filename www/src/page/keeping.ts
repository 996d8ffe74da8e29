/** Support and consent for keeping models between visits. */
import { readKept, writeKept } from "./storage.js";

/** False in older Safari and on pages without TLS. Some private windows refuse only later: see `recentModels()`. */
export const canKeep = (): boolean =>
  "createWritable" in (globalThis.FileSystemFileHandle?.prototype ?? {}) && "locks" in navigator && "getDirectory" in navigator.storage;

export const isKeeping = (): boolean => readKept("models") !== null;

export function setKeeping(is: boolean): void {
  writeKept("models", is ? "kept" : null);
}
