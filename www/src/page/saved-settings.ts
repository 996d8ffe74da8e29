/**
 * Named settings, as queries. They hold the choices that apply to many models, but not the height, the rotation and points placed by hand,
 * which belong to one model.
 */
import { DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "../element/state/settings.js";

export interface SavedSettings {
  readonly name: string;
  readonly query: string;
}

export const LONGEST_NAME = 60;

/** Settings that belong to the model. */
const ofModel = ({ height, rotation, points, drains, fill }: Settings): Partial<Settings> => ({ height, rotation, points, drains, fill });

/** A query without the settings of the model. */
export function savedQuery(query: string): string {
  return toAddress({ ...fromAddress(query), ...ofModel(DEFAULT_SETTINGS) });
}

/** A saved query with the settings of the open model. */
export function appliedTo(current: string, saved: string): string {
  return toAddress({ ...fromAddress(saved), ...ofModel(fromAddress(current)) });
}

/** Parses a saved list; malformed entries are dropped. */
export function savedIn(text: string | null): SavedSettings[] {
  try {
    const list: unknown = JSON.parse(text ?? "[]");
    return Array.isArray(list) ? list.filter(isSaved) : [];
  } catch {
    return [];
  }
}

function isSaved(it: unknown): it is SavedSettings {
  const { name, query } = (it ?? {}) as Record<string, unknown>;
  return typeof name === "string" && name.trim() !== "" && typeof query === "string";
}

/** Returns true if both names look the same to a user. */
export const isNamed = (name: string, other: string): boolean => name.trim().toLowerCase() === other.trim().toLowerCase();

const COLLATOR = new Intl.Collator(undefined, { numeric: true });

/** The list with these settings, which replace those of the same name, in alphabetical order. */
export function withSaved(list: readonly SavedSettings[], { name, query }: SavedSettings): SavedSettings[] {
  const own = { name: name.trim().slice(0, LONGEST_NAME), query };
  return [...withoutSaved(list, name), own].sort((a, b) => COLLATOR.compare(a.name, b.name));
}

export function withoutSaved(list: readonly SavedSettings[], name: string): SavedSettings[] {
  return list.filter((it) => !isNamed(it.name, name));
}
