/** Text from outside in what is said of failures: characters that act, or turn a line around, are shown and not obeyed. */

/** Control characters, ends of lines, and marks of the direction of writing, as the command line has them. */
const ACTING = /[\p{Cc}\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff]/gu;

/** A value with every text in it as `\u{1b}`. */
export function visible(value: unknown): unknown {
  if (typeof value === "string") return value.replace(ACTING, (character) => `\\u{${(character.codePointAt(0) ?? 0).toString(16)}}`);
  if (Array.isArray(value)) return value.map(visible);
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, visible(inner)]));
}
