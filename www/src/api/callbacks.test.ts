import * as Comlink from "comlink";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { listenTo, callback, release } from "./callbacks.js";

/** Page's end of the worker: receives its messages, while transferred buffers are detached at the worker's end. */
let worker: EventTarget;

beforeEach(() => {
  worker = new EventTarget();
  vi.stubGlobal("postMessage", (data: unknown, options: { transfer: ArrayBuffer[] }) => {
    worker.dispatchEvent(new MessageEvent("message", { data: structuredClone(data, options) }));
  });
  listenTo(worker as Worker);
});

afterEach(() => vi.unstubAllGlobals());

/** The function that a worker receives in place of `listener`. */
function sent<L>(listener: L): L {
  const handler = Comlink.transferHandlers.get("callback");
  if (handler?.canHandle(listener) !== true) throw new Error("it cannot be sent");
  const [number, transferred] = handler.serialize(listener);
  expect(transferred).toEqual([]);
  return handler.deserialize(structuredClone(number)) as L;
}

test("a function is called while the worker has not returned, and no more once the call is over", () => {
  const heard: unknown[] = [];
  const progress = callback((stage: string, fraction: number) => void heard.push([stage, fraction]));
  const other = callback(() => void heard.push("other"));
  const [remote, remoteOther] = [sent(progress), sent(other)];
  remote("ldi", 0.5);
  remoteOther();
  remote("plan", 1);
  expect(heard).toEqual([["ldi", 0.5], "other", ["plan", 1]]);
  release(progress);
  remote("late", 1);
  expect(heard).toHaveLength(3);
  // The same function may be used again.
  callback(progress);
  remote("again", 0);
  expect(heard).toHaveLength(4);
});

test("bytes are handed over, not copied", () => {
  const chunks: Uint8Array[] = [];
  const take = callback((chunk: Uint8Array) => void chunks.push(chunk));
  const bytes = Uint8Array.of(1, 2, 3);
  sent(take)(bytes);
  expect(chunks).toEqual([Uint8Array.of(1, 2, 3)]);
  expect(bytes.buffer.byteLength).toBe(0);
});

test("other messages of the worker, and functions that are no callbacks, are left alone", () => {
  for (const data of [null, { id: "1" }, { listener: 1e9, what: [] }]) worker.dispatchEvent(new MessageEvent("message", { data }));
  expect(Comlink.transferHandlers.get("callback")?.canHandle(() => undefined)).toBe(false);
});
