/** Plain data as a page gives it: objects, lists and arrays of numbers. */

/** Returns true if both have the same content. */
export function isEqual(a: unknown, b: unknown): boolean {
  if (Object.is(a, b)) return true;
  if (a instanceof Float32Array && b instanceof Float32Array) return a.length === b.length && a.every((it, i) => Object.is(it, b[i]));
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null || Array.isArray(a) !== Array.isArray(b)) return false;
  const [own, other] = [Object.entries(a), b as Record<string, unknown>];
  return own.length === Object.keys(b).length && own.every(([key, it]) => key in other && isEqual(it, other[key]));
}

/** A copy that a page cannot change any more, and that crosses to a worker where a framework watches the page's own by a proxy. */
export function copyOf<T>(value: T): T {
  if (value instanceof Float32Array) return value.slice() as typeof value;
  if (Array.isArray(value)) return value.map(copyOf) as typeof value;
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, it]) => [key, copyOf(it)])) as typeof value;
}
