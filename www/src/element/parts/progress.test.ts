import { expect, test } from "vitest";
import type { Stage } from "../../api/wire.js";
import { standing } from "./progress.js";

test("progress never runs backwards over the stages of a plan, and an export counts its own", () => {
  const at = (stage: Stage, task: "plan" | "export"): number =>
    standing({ task, name: "", stage, fraction: 0.5, started_ms: 0 }, 0).done;
  const stages = (["load", "saliency", "ldi", "profile", "plan"] as const).map((stage) => at(stage, "plan"));
  expect(stages).toEqual([...stages].sort((a, b) => a - b));
  expect(new Set(stages).size).toBe(5);
  expect(at("masks", "export")).toBe(0.5);
  expect(at("ldi", "export")).toBe(0);
});

test("the time left is guessed from what is done, not before there is something to go by", () => {
  const at = (fraction: number, now_ms: number): number | null =>
    standing({ task: "export", name: "", stage: "masks", fraction, started_ms: 0 }, now_ms).left_s;
  expect(at(0.25, 5000)).toBe(15);
  expect(at(0.25, 500)).toBeNull();
  expect(at(0.01, 5000)).toBeNull();
});
