import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Client } from "./client.js";
import { Helpers } from "./helpers.js";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

/** Clients that answer on request of the test. */
function fakes() {
  const log: string[] = [];
  const waiting: { answer: (bytes: Uint8Array) => void; fail: (error: Error) => void }[] = [];
  const start = (): Client => {
    const name = log.push("started");
    return {
      encodeGroup: () => {
        log.push(`${name} encodes`);
        return new Promise((answer, fail) => void waiting.push({ answer, fail }));
      },
      rest: () => void log.push(`${name} rests`),
      dispose: () => void log.push(`${name} ends`),
    } as unknown as Client;
  };
  return { log, waiting, start };
}

const encode = (helpers: Helpers): Promise<Uint8Array | null> => helpers.encode("png", new Uint32Array(3), new Uint32Array(1));

test("the least busy helper encodes, and no more are started than there may be", async () => {
  const { log, waiting, start } = fakes();
  const helpers = new Helpers(start, 2);
  const all = [encode(helpers), encode(helpers), encode(helpers)];
  expect(log).toEqual(["started", "1 encodes", "started", "3 encodes", "1 encodes"]);
  waiting[1]?.answer(new Uint8Array([7]));
  expect(await all[1]).toEqual(new Uint8Array([7]));
  void encode(helpers);
  expect(log.at(-1)).toBe("3 encodes");
});

test("a helper that fails leaves its group to whoever asked", async () => {
  const { waiting, start } = fakes();
  const group = encode(new Helpers(start, 1));
  waiting[0]?.fail(new Error("out of memory"));
  expect(await group).toBeNull();
});

test("helpers end when they have long been idle", async () => {
  const { log, waiting, start } = fakes();
  const helpers = new Helpers(start, 9);
  const group = encode(helpers);
  await vi.advanceTimersByTimeAsync(60_000);
  expect(log).not.toContain("1 rests");
  waiting[0]?.answer(new Uint8Array());
  await group;
  await vi.advanceTimersByTimeAsync(60_000);
  expect(log).toContain("1 rests");
});
