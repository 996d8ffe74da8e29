/** Support for keeping work between visits, which the user may turn off. */
import { readKept, writeKept } from "./storage.js";

/** False in older Safari and on pages without TLS. Some private windows refuse only later: see `recentWorks()`. */
export const canKeep = (): boolean =>
  "createWritable" in (globalThis.FileSystemFileHandle?.prototype ?? {}) && "locks" in navigator && "getDirectory" in navigator.storage;

export const isKeeping = (): boolean => readKept("work") !== "off";

/** Returns true if work has been kept before. */
export const hasKept = (): boolean => readKept("work") === "on";

/** Returns true on success. */
export function setKeeping(is: boolean): boolean {
  return writeKept("work", is ? "on" : "off");
}
