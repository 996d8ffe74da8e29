/** A browser with one tab, as driven by the tests through either of WebDriver's protocols. */
import { dom, type Dom } from "./dom.js";
import type { Programs } from "./programs.js";

/** Input sources and their actions, in the form common to both protocols. */
export type Source =
  | { type: "key"; id: string; actions: { type: "keyDown" | "keyUp"; value: string }[] }
  | { type: "pointer"; id: string; actions: ({ type: "pointerMove"; x: number; y: number } | { type: "pointerDown" | "pointerUp"; button: number })[] };

/** A function run in the page, which refers to nothing outside itself. Arguments and result are JSON. */
export type InPage<A extends readonly unknown[], R> = (dom: Dom, ...args: A) => R | Promise<R>;

/** Source of a function from JSON to JSON. The result is in a list, since `undefined` has no JSON. */
export const sourceOf = (body: unknown): string =>
  `async (args) => JSON.stringify([await (${String(body)})((${String(dom)})(), ...JSON.parse(args))])`;

/** Source of a function that waits some seconds for an element. */
export const awaited = (find: () => Element | null | undefined): string =>
  `async () => {
    for (let round = 0; round < 200; round++) {
      const found = (${String(find)})();
      if (found) return found;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    return null;
  }`;

export interface Session {
  /** Folder for downloads. */
  downloads: string;
  /** Exceptions and logged errors of the page since the last call. */
  complaints(): Promise<string[]>;
  /** Opens a URL, and waits until it is loaded. */
  open(address: string): Promise<void>;
  call<A extends readonly unknown[], R>(body: InPage<A, R>, ...args: A): Promise<R>;
  act(source: Source): Promise<void>;
  /** Sets the file of an input, once present. Such inputs are invisible to users. */
  give(find: () => Element | null | undefined, file: string): Promise<void>;
}

export interface Engine {
  name: string;
  /** The first missing requirement on this machine; null if there is none. */
  lacks(): string | null;
  /**
   * @param folder empty folder for the browser's files
   * @param proxy port of the proxy that stands for all other hosts
   */
  start(folder: string, programs: Programs, proxy: number): Promise<Session>;
  /** Returns true if the browser itself requests this host, independently of the page. */
  asks(host: string): boolean;
}
