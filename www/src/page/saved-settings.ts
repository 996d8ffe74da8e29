/**
 * Settings with names, as queries. A name stands for what a person decides for many models; the height, the rotation and
 * what was placed by hand are one model's, so they are not part of it.
 */
import { DEFAULT_SETTINGS, fromAddress, toAddress, type Settings } from "../element/state/settings.js";

export interface SavedSettings {
  readonly name: string;
  readonly query: string;
}

export const LONGEST_NAME = 60;

/** What belongs to the model. */
const ofModel = ({ height, rotation, points, drains, fill }: Settings): Partial<Settings> => ({ height, rotation, points, drains, fill });

/** A query without what belongs to the model. */
export function savedQuery(query: string): string {
  return toAddress({ ...fromAddress(query), ...ofModel(DEFAULT_SETTINGS) });
}

/** A saved query with what belongs to the model that is open. */
export function appliedTo(current: string, saved: string): string {
  return toAddress({ ...fromAddress(saved), ...ofModel(fromAddress(current)) });
}

/** The list of a kept text; whatever is not one of ours is left out. */
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

/** Returns true if both are the same name to a person. */
export const isNamed = (name: string, other: string): boolean => name.trim().toLowerCase() === other.trim().toLowerCase();

const COLLATOR = new Intl.Collator(undefined, { numeric: true });

/** The list with these settings, in place of those of the same name, in alphabetical order. */
export function withSaved(list: readonly SavedSettings[], { name, query }: SavedSettings): SavedSettings[] {
  const own = { name: name.trim().slice(0, LONGEST_NAME), query };
  return [...withoutSaved(list, name), own].sort((a, b) => COLLATOR.compare(a.name, b.name));
}

export function withoutSaved(list: readonly SavedSettings[], name: string): SavedSettings[] {
  return list.filter((it) => !isNamed(it.name, name));
}
