import { expect, test } from "vitest";
import { ofCore, SlicerError } from "./error.js";

test("an error from the core keeps its code and details; any other value gives null", () => {
  const error = ofCore({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  expect(error).toBeInstanceOf(SlicerError);
  expect(error).toMatchObject({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  for (const other of [null, "no", new Error("no"), { message: "no" }]) expect(ofCore(other)).toBeNull();
});
