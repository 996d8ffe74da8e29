/** Makes control characters in outside text visible in messages, so that they have no effect. */

/** Control characters, line breaks and marks of writing direction, the same set as in the command line. */
const ACTING = /[\p{Cc}\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/gu;

/** A name, as of a file, with control characters made visible. */
export function shown(name: string): string {
  return name.replace(ACTING, (character) => `\\u{${(character.codePointAt(0) ?? 0).toString(16)}}`);
}

/** A value with control characters made visible in all its strings. */
export function visible(value: unknown): unknown {
  if (typeof value === "string") return shown(value);
  if (Array.isArray(value)) return value.map(visible);
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, visible(inner)]));
}
