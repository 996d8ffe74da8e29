/** Code that is fetched on first use, with a retry after a failure. */
import { said } from "../../api/error.js";

/**
 * Wraps `load`, which imports the code. A browser caches a failed import for the lifetime of the page, so a retry uses another URL: the one
 * named by the failure, with a query that servers ignore. If it names none, only a reload helps. Bundlers must not resolve that import.
 */
export function fetched<Code>(load: () => Promise<Code>): () => Promise<Code> {
  let other: string | null = null;
  return async () => {
    try {
      return await (other === null ? load() : (import(/* @vite-ignore */ /* webpackIgnore: true */ other) as Promise<Code>));
    } catch (error) {
      other = otherAddress(said(error));
      throw error;
    }
  };
}

/** URL in the browser's message of a failed import. Bundlers with their own loaders word it differently, but retry on request. */
function otherAddress(failure: string): string | null {
  const named = /dynamically imported module: (https?:\S+)/.exec(failure)?.[1];
  if (named === undefined) return null;
  const address = new URL(named);
  address.searchParams.set("try", String(Number(address.searchParams.get("try") ?? 1) + 1));
  return address.href;
}
