import { expect, test } from "vitest";
import { advanced, secondsLeft, type Busy } from "./progress.js";

const START: Busy = { task: "export", name: "", stage: "masks", fraction: 0, done: 0, started_ms: 0 };

test("the time left is estimated from progress, once there is enough of it", () => {
  const at = (done: number, now_ms: number): number | null => secondsLeft({ ...START, done }, now_ms);
  expect(at(0.25, 5000)).toBe(15);
  expect(at(0.25, 500)).toBeNull();
  expect(at(0.01, 5000)).toBeNull();
});

test("an export that first replays a plan is timed from its own start", () => {
  const planned = advanced(START, { stage: "plan", fraction: 1, done: 1 }, 8000);
  expect(planned.started_ms).toBe(0);
  const writing = advanced(planned, { stage: "masks", fraction: 0, done: 0 }, 9000);
  expect(writing).toEqual({ ...START, started_ms: 9000 });
  expect(secondsLeft(advanced(writing, { stage: "masks", fraction: 0.5, done: 0.5 }, 11_000), 11_000)).toBe(2);
});
