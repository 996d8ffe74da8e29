/** A browser with one tab, as the tests drive it: what both of WebDriver's protocols can do. */
import { dom, type Dom } from "./dom.js";
import type { Programs } from "./programs.js";

/** Sources of input and what they do. Both protocols write them alike. */
export type Source =
  | { type: "key"; id: string; actions: { type: "keyDown" | "keyUp"; value: string }[] }
  | { type: "pointer"; id: string; actions: ({ type: "pointerMove"; x: number; y: number } | { type: "pointerDown" | "pointerUp"; button: number })[] };

/** A function of the page, which refers to nothing outside itself. Arguments and result are JSON. */
export type InPage<A extends readonly unknown[], R> = (dom: Dom, ...args: A) => R | Promise<R>;

/** The source of a function from JSON to JSON. The result is a list of one, since there is no JSON of nothing. */
export const sourceOf = (body: unknown): string =>
  `async (args) => JSON.stringify([await (${String(body)})((${String(dom)})(), ...JSON.parse(args))])`;

/** The source of a function that waits until an element is there, for some seconds. */
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
  /** The folder in which downloads end up. */
  downloads: string;
  /** What the page threw or logged as an error since this was last asked. */
  complaints(): Promise<string[]>;
  /** Opens an address, and waits until it is loaded. */
  open(address: string): Promise<void>;
  call<A extends readonly unknown[], R>(body: InPage<A, R>, ...args: A): Promise<R>;
  act(source: Source): Promise<void>;
  /** Gives a file of this machine to an input, once that is there. Such inputs are hidden behind what people see. */
  give(find: () => Element | null | undefined, file: string): Promise<void>;
}

export interface Engine {
  name: string;
  /** The first thing that this machine lacks; null if it has all. */
  lacks(): string | null;
  /**
   * @param folder an empty one, for what the browser writes
   * @param proxy the port of what stands for all other machines
   */
  start(folder: string, programs: Programs, proxy: number): Promise<Session>;
  /** Returns true if the browser asks this host for something by itself, whatever page is open. */
  asks(host: string): boolean;
}
