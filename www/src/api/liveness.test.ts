import { afterEach, expect, test, vi } from "vitest";
import { holdLock, whenEnded } from "./liveness.js";

afterEach(() => void vi.unstubAllGlobals());

/** Fake exclusive locks, and functions that end holders that never release theirs. */
function fakeLocks() {
  const queues = new Map<string, Promise<unknown>>();
  const ends: (() => void)[] = [];
  const request = (name: string, task: () => unknown): Promise<unknown> => {
    const ended = new Promise<void>((resolve) => ends.push(resolve));
    const before = queues.get(name) ?? Promise.resolve();
    const done = before.then(() => Promise.race([task(), ended]));
    queues.set(name, done);
    return done;
  };
  return { request, ends };
}

test("a page is told when a worker has ended, however long that was silent, and not before", async () => {
  const locks = fakeLocks();
  vi.stubGlobal("navigator", { locks });
  const worker = new EventTarget() as Worker;
  vi.stubGlobal("postMessage", (data: unknown) => worker.dispatchEvent(new MessageEvent("message", { data })));
  const ended = vi.fn<() => void>();
  whenEnded(worker, ended);
  holdLock();
  for (const data of [null, "text", { id: "an answer" }]) worker.dispatchEvent(new MessageEvent("message", { data }));
  await new Promise((resolve) => setTimeout(resolve));
  expect(ended).not.toHaveBeenCalled();
  locks.ends[0]?.();
  await expect.poll(() => ended.mock.calls).toHaveLength(1);
});

test("without locks a worker works as before", () => {
  vi.stubGlobal("navigator", {});
  expect(holdLock).not.toThrow();
});

test("a lock that is refused, as in an opaque origin, is none", async () => {
  const said = vi.fn<() => void>();
  vi.stubGlobal("postMessage", said);
  vi.stubGlobal("navigator", { locks: { request: () => Promise.reject(new DOMException("opaque", "SecurityError")) } });
  holdLock();
  await new Promise((resolve) => setTimeout(resolve));
  expect(said).not.toHaveBeenCalled();
});
