import { expect, test } from "vitest";
import { knownPrinter } from "../state/printer-fixture.js";
import { found } from "./printer-search.js";

const named = (name: string, model: string): ReturnType<typeof knownPrinter> => knownPrinter({ name, model });
const PRINTERS = [named("x10", "EPAX X10"), named("x1", "EPAX X1"), named("s3u", "Elegoo Saturn 3 Ultra"), named("s3", "Elegoo Saturn 3"), named("s", "Elegoo Saturn"), named("one", "Solus")];

const names = (text: string, recent: readonly string[] = []): string[] => found(PRINTERS, text, recent).map(({ value }) => value);

test("printers are found by words of maker and model in any order and case, sorted as people count", () => {
  expect(names("")).toEqual(["s", "s3", "s3u", "x1", "x10", "one"]);
  expect(names("ULTRA saturn")).toEqual(["s3u"]);
  expect(names("epax ")).toEqual(["x1", "x10"]);
  expect(names("prusa")).toEqual([]);
});

test("printers chosen before come first, the last at the top, and unknown ones are ignored", () => {
  expect(names("", ["x10", "gone", "s3"])).toEqual(["x10", "s3", "s", "s3u", "x1", "one"]);
  expect(names("saturn", ["x10", "s3"])).toEqual(["s3", "s", "s3u"]);
});
