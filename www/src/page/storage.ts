/**
 * Texts that this browser keeps between visits. A private window or a full storage may keep nothing, which is never an error:
 * the page then starts as on a first visit.
 */

/** What is kept: a person's printer and resin, named settings, leave to keep models, and whether the tour and `?` are wanted. */
export type KeptKey = "printer" | "settings" | "models" | "tour" | "question-mark";

const PREFIX = "cusp.";

export function readKept(key: KeptKey): string | null {
  try {
    return localStorage.getItem(PREFIX + key);
  } catch {
    return null;
  }
}

/** Keeps a text, or removes it if it is null. Returns whether the browser did so. */
export function writeKept(key: KeptKey, text: string | null): boolean {
  try {
    if (text === null) localStorage.removeItem(PREFIX + key);
    else localStorage.setItem(PREFIX + key, text);
    return true;
  } catch {
    return false;
  }
}
