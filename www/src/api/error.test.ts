import { expect, test } from "vitest";
import { ofCore, SlicerError } from "./error.js";

test("an error from the core keeps its code and details; any other value gives null", () => {
  const error = ofCore({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  expect(error).toBeInstanceOf(SlicerError);
  expect(error).toMatchObject({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  for (const other of [null, "no", new Error("no"), { message: "no" }]) expect(ofCore(other)).toBeNull();
});

test("text from outside in an error is shown and does not act", () => {
  const key = "x\n\u001b[31mall is well\u202e";
  const error = ofCore({ code: "bad-options", message: `no ${key}`, detail: { system: key, known: [key, 5] } });
  const shown = "x\\u{a}\\u{1b}[31mall is well\\u{202e}";
  expect(error).toMatchObject({ message: `no ${shown}`, detail: { system: shown, known: [shown, 5] } });
});
