import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, test } from "vitest";
import { ERROR_CODES, ofCore, SlicerError } from "./error.js";

const core = fileURLToPath(new URL("../../../src", import.meta.url));

/** Codes that the core's `fn code(&self) -> &'static str` functions give. */
async function coreCodes(): Promise<string[]> {
  const codes = new Set<string>();
  for (const name of await readdir(core, { recursive: true })) {
    if (!name.endsWith(".rs")) continue;
    const text = await readFile(join(core, name), "utf8");
    for (const [body] of text.matchAll(/fn code\(&self\) -> &'static str \{.*?\n {4}\}\n/gs)) {
      for (const [, code = ""] of body.matchAll(/=> "([a-z-]+)"/g)) codes.add(code);
    }
  }
  return [...codes].sort();
}

/** Those that only the command line can meet: parts of a search are merged there alone. */
const NATIVE = ["merge-none", "merge-version", "merge-options", "merge-duplicate", "merge-damaged", "merge-gap"];

/** Those that only this side gives. */
const OWN = [
  "bad-attribute",
  "no-model",
  "file-unreadable",
  "fetch-failed",
  "start-failed",
  "part-failed",
  "no-browser",
  "crash",
];

test("the list of codes is the core's and this side's, no more and no fewer", async () => {
  const codes = await coreCodes();
  expect(codes).toContain("infeasible");
  expect(codes).toEqual(expect.arrayContaining(NATIVE));
  const shared = codes.filter((code) => !NATIVE.includes(code));
  expect(Object.keys(ERROR_CODES).sort()).toEqual([...shared, ...OWN].sort());
});

test("what the core describes becomes an error with its code and details; anything else does not", () => {
  const error = ofCore({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  expect(error).toBeInstanceOf(SlicerError);
  expect(error).toMatchObject({ code: "infeasible", message: "no", detail: { from_mm: 1 } });
  for (const other of [null, "no", new Error("no"), { message: "no" }]) expect(ofCore(other)).toBeNull();
});
