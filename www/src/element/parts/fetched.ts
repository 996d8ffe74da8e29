/** Code that is fetched when it is first wanted, and once more when it is wanted after a failure. */
import { said } from "../../api/error.js";

/**
 * `load` imports the code. A browser keeps the failure of an import for as long as the page is there, so the next try has another
 * address: the one that the failure names, with a query that servers ignore. Where it names none, only a reload helps. Bundlers must not look for it.
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

/** Browsers name the address like this. Bundlers that load code by themselves say something else, and try again when they are asked to. */
function otherAddress(failure: string): string | null {
  const named = /dynamically imported module: (https?:\S+)/.exec(failure)?.[1];
  if (named === undefined) return null;
  const address = new URL(named);
  address.searchParams.set("try", String(Number(address.searchParams.get("try") ?? 1) + 1));
  return address.href;
}
