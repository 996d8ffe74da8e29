import { expect, it } from "vitest";
import { inParts } from "./work.js";

function* counting(until: number, step_ms: number): Generator<number, string> {
  for (let i = 0; i < until; i++) {
    const end = performance.now() + step_ms;
    while (performance.now() < end);
    yield i / until;
  }
  return "done";
}

it("returns the result, reports progress, and lets other tasks run", async () => {
  const told: number[] = [];
  let turns = 0;
  let isRunning = true;
  const others = (async () => {
    while (isRunning) {
      turns++;
      await new Promise((resolve) => setTimeout(resolve));
    }
  })();
  const result = await inParts(counting(300, 1), new AbortController().signal, (progress) => told.push(progress));
  isRunning = false;
  await others;
  expect(result).toBe("done");
  expect(told.length).toBeGreaterThan(0);
  expect(told.toSorted((a, b) => a - b)).toEqual(told);
  expect(turns).toBeGreaterThan(3);
});

it("stops when it is aborted", async () => {
  const stop = new AbortController();
  const work = inParts(counting(1_000_000, 1), stop.signal);
  setTimeout(() => stop.abort(new Error("no longer")));
  await expect(work).rejects.toThrow("no longer");
});
