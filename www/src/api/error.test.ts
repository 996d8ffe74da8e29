import { expect, test } from "vitest";
import { ofCore, SlicerError } from "./error.js";

test("what the core describes becomes an error with its code and details; anything else does not", () => {
  const error = ofCore({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  expect(error).toBeInstanceOf(SlicerError);
  expect(error).toMatchObject({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  for (const other of [null, "no", new Error("no"), { message: "no" }]) expect(ofCore(other)).toBeNull();
});
