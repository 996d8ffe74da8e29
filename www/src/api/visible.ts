/** Text from outside in what is said of failures: characters that act, or turn a line around, are shown and not obeyed. */

/** Control characters, ends of lines, and marks of the direction of writing, as the command line has them. */
const ACTING = /[\p{Cc}\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/gu;

/** A name, as of a file, as it is shown. */
export function shown(name: string): string {
  return name.replace(ACTING, (character) => `\\u{${(character.codePointAt(0) ?? 0).toString(16)}}`);
}

/** A value with every text in it as it is shown. */
export function visible(value: unknown): unknown {
  if (typeof value === "string") return shown(value);
  if (Array.isArray(value)) return value.map(visible);
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, visible(inner)]));
}
