/**
 * Texts kept by this browser between visits. A private window or a full storage may keep nothing, which is never an error: the page then
 * starts as on a first visit.
 */

/** Texts kept: the user's printer and resin, names of printers chosen before, named settings, whether work is kept, and whether the tour and `?` are wanted. */
export type KeptKey = "printer" | "printers" | "settings" | "work" | "tour" | "question-mark";

const PREFIX = "cusp.";

export function readKept(key: KeptKey): string | null {
  try {
    return localStorage.getItem(PREFIX + key);
  } catch {
    return null;
  }
}

/** Stores a text, or removes it if null. Returns true on success. */
export function writeKept(key: KeptKey, text: string | null): boolean {
  try {
    if (text === null) localStorage.removeItem(PREFIX + key);
    else localStorage.setItem(PREFIX + key, text);
    return true;
  } catch {
    return false;
  }
}
