/**
 * Callbacks: functions of the page that a worker calls while it computes.
 *
 * The calls cross as messages of the worker itself. Comlink's proxies have a port each, and Firefox holds back messages through a port that
 * arrived with a call until that call is over.
 */
import * as Comlink from "comlink";

type Listener = (...what: never[]) => void;

/** A call of a listener, as a message. */
interface Telling {
  listener: number;
  what: unknown[];
}

const numbers = new WeakMap<Listener, number>();
const listeners = new Map<number, Listener>();
let last = 0;

/** Registers a function that workers may call while they compute. Its arguments must be cloneable; byte arrays are transferred. */
export function callback<L extends Listener>(listener: L): L {
  if (!numbers.has(listener)) numbers.set(listener, ++last);
  listeners.set(numbers.get(listener) ?? 0, listener);
  return listener;
}

/** Unregisters a callback. */
export function release(listener: Listener): void {
  listeners.delete(numbers.get(listener) ?? 0);
}

/** Dispatches a worker's messages to the callbacks. */
export function listenTo(worker: Worker): void {
  worker.addEventListener("message", ({ data }: MessageEvent<Partial<Telling> | null>) => {
    if (data?.listener !== undefined) listeners.get(data.listener)?.(...((data.what ?? []) as never[]));
  });
}

const isListener = (value: unknown): value is Listener => typeof value === "function" && numbers.has(value as Listener);

const tell = (listener: number): ((...what: unknown[]) => void) => {
  return (...what) => {
    const telling: Telling = { listener, what };
    const bytes = what.filter((it) => it instanceof Uint8Array);
    globalThis.postMessage(telling, { transfer: bytes.map(({ buffer }) => buffer as ArrayBuffer) });
  };
};

// Page and worker both import this module.
Comlink.transferHandlers.set("callback", {
  canHandle: isListener,
  serialize: (listener: Listener) => [numbers.get(listener) ?? 0, []],
  deserialize: tell,
});
