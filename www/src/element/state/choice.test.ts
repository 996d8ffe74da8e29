import { expect, test } from "vitest";
import type { Format as PrintFormat, Printer, Report } from "../../api/wire.js";
import { languageOf, LANGUAGES, type Language } from "../../texts/index.js";
import { fileWords } from "../parts/file-words.js";
import { choose, formatFor } from "./choice.js";
import { report } from "./report-fixture.js";

test.each([
  [[], []],
  // The core inspects the content and reports what it is.
  [["a.txt", "b.3mf"], ["a.txt"]],
  [["A.STL"], ["A.STL"]],
  [["model"], ["model"]],
  [["notes.txt", "b.stl", "c.stl"], ["b.stl", "c.stl"]],
])("of %j, the STLs are taken", (names, taken) => {
  expect(choose(names.map((name) => ({ name }))).map(({ name }) => name)).toEqual(taken);
});

const PRINTERS = (
  [
    ["saturn", "Saturn", "chitubox", ["ctb", "goo"], false],
    ["shuffle", "Shuffle", "chitubox", ["zip"], true],
    ["sl1s", "SL1S", "sl1", ["sl1s"], true],
  ] as const
).map(([name, model, format, reads, reads_format]): Printer => ({
  ...{ name, model, format, reads: [...reads], reads_format },
  ...{ pixels: [100, 100], pitch_um: [50, 50], volume_mm: [5, 5, 5], layer_mm: [0.02, 0.2], is_mirrored: true, step_mm: 0.002 },
}));

test("the format is the printer's own if none is chosen", () => {
  expect(formatFor({ printer: "", format: "" }, PRINTERS)).toBe("png");
  expect(formatFor({ printer: "sl1s", format: "" }, PRINTERS)).toBe("sl1");
  expect(formatFor({ printer: "sl1s", format: "uvj" }, PRINTERS)).toBe("uvj");
});

test.each<[string, { printer?: string; format?: PrintFormat }, Report["planner"], string]>([
  ["no printer", {}, "optimal", "A zip of layer images."],
  ["no printer, a format", { format: "chitubox" }, "optimal", "A ChiTuBox zip."],
  ["one that needs a converter", { printer: "saturn" }, "optimal", "A ChiTuBox zip. The Saturn reads .ctb or .goo: convert it with UVtools first."],
  ["one that reads it", { printer: "shuffle" }, "optimal", "A ChiTuBox zip. The Shuffle reads it directly."],
  ["one that reads another zip", { printer: "shuffle", format: "png" }, "optimal", "A zip of layer images. The Shuffle cannot read it."],
  ["one that reads uniform layers", { printer: "sl1s" }, "uniform", "A Prusa SL1 file. The SL1S reads it directly."],
  [
    "one that reads uniform layers alone",
    { printer: "sl1s" },
    "optimal",
    "A Prusa SL1 file. This file has one thickness for all layers: choose uniform ones for it.",
  ],
])("the line at the download, %s: what the file is and what it needs", (_name, options, planner, said) => {
  const printer = PRINTERS.find(({ name }) => name === options.printer);
  const format = options.format ?? printer?.format ?? "png";
  const is_read_by_printer = printer?.reads_format === true && printer.format === format;
  const print_file = { format, extension: "", media_type: "", is_read_by_printer };
  const patch = { planner, print_file, printer: printer?.name ?? null };
  const words = (language: Language): string => fileWords({ report: report(patch) }, PRINTERS, language);
  expect(words(languageOf("en"))).toBe(`${said} The model prints as it is: no supports, not hollowed.`);
  const others = LANGUAGES.map((code) => words(languageOf(code)));
  expect(new Set(others).size).toBe(LANGUAGES.length);
  for (const other of others) expect(other).not.toContain("undefined");
});
