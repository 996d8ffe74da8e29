/** Plain data from a page: objects, lists and arrays of numbers. */

/** Returns true if both have equal contents. */
export function isEqual(a: unknown, b: unknown): boolean {
  if (Object.is(a, b)) return true;
  if (a instanceof Float32Array && b instanceof Float32Array) return a.length === b.length && a.every((it, i) => Object.is(it, b[i]));
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null || Array.isArray(a) !== Array.isArray(b)) return false;
  const [own, other] = [Object.entries(a), b as Record<string, unknown>];
  return own.length === Object.keys(b).length && own.every(([key, it]) => key in other && isEqual(it, other[key]));
}

/** A deep copy that the page cannot change. Unlike proxies, with which frameworks watch data, it can be sent to a worker. */
export function copyOf<T>(value: T): T {
  if (value instanceof Float32Array) return value.slice() as typeof value;
  if (Array.isArray(value)) return value.map(copyOf) as typeof value;
  if (typeof value !== "object" || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, it]) => [key, copyOf(it)])) as typeof value;
}
