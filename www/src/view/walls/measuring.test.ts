import { afterEach, expect, it, vi } from "vitest";
import { ball, box } from "../fixtures.js";
import { Derived } from "../steps/derived.js";
import { Measuring } from "./measuring.js";
import type { Walls } from "./thickness.js";

interface Told {
  walls: (Walls | null)[];
  progress: (number | null)[];
}

function measuring(): { told: Told; job: Measuring } {
  const told: Told = { walls: [], progress: [] };
  const job = new Measuring({ walls: (walls) => told.walls.push(walls), progress: (progress) => told.progress.push(progress) });
  return { told, job };
}

/** Generous, for a busy machine. */
const LATE = { timeout: 20_000 };

afterEach(() => void vi.restoreAllMocks());

const cube = (): Derived => new Derived(box([0, 0, 0], [1, 1, 1]));

it("measures a model once, however often it is shown", async () => {
  // Stops the clock: on a busy machine even this work would not be quick.
  vi.spyOn(performance, "now").mockReturnValue(0);
  const { told, job } = measuring();
  const of = cube();
  job.want(of);
  await expect.poll(() => told.walls.length, LATE).toBe(1);
  job.want(null);
  job.want(of);
  await new Promise((resolve) => setTimeout(resolve, 50));
  expect(told.walls).toHaveLength(1);
  expect(told.walls[0]?.thickness_mm.every((mm) => Math.abs(mm - 1) < 1e-5)).toBe(true);
  // Quick work reports none.
  expect(told.progress.every((progress) => progress === null)).toBe(true);
}, 30_000);

it("gives up for another model, and when nobody wants to see it, and begins again then", async () => {
  const { told, job } = measuring();
  const large = new Derived(ball(5, 200));
  job.want(large);
  await new Promise((resolve) => setTimeout(resolve, 30));
  job.want(null);
  await new Promise((resolve) => setTimeout(resolve, 200));
  expect(told.walls).toEqual([]);
  job.want(large);
  await new Promise((resolve) => setTimeout(resolve, 30));
  job.forget();
  large.dispose();
  const next = cube();
  job.want(next);
  await expect.poll(() => told.walls.length, LATE).toBe(2);
  expect(told.walls[0]).toBeNull();
  expect(told.walls[1]?.thickness_mm[0]).toBeCloseTo(1, 5);
  await new Promise((resolve) => setTimeout(resolve, 200));
  expect(told.walls).toHaveLength(2);
}, 30_000);

it("tells how far long work is, until it is done", async () => {
  // Each reading of the clock advances it by 10 ms, so that a small model is long work.
  let now_ms = 0;
  vi.spyOn(performance, "now").mockImplementation(() => (now_ms += 10));
  const { told, job } = measuring();
  job.want(new Derived(ball(5, 100)));
  await expect.poll(() => told.walls.length, LATE).toBe(1);
  const numbers = told.progress.filter((progress) => progress !== null);
  expect(numbers.length).toBeGreaterThan(1);
  expect(numbers.toSorted((a, b) => a - b)).toEqual(numbers);
  expect(told.progress.at(-1)).toBeNull();
}, 30_000);
