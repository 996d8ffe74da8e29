import { expect, test } from "vitest";
import type { Format as PrintFormat, Printer, Warning, ModelReport } from "../../api/wire.js";
import { languageOf, LANGUAGES, type Language } from "../../texts/index.js";
import { fileWords } from "../parts/file-words.js";
import { formatFor, isPrinter, printerFrom, printerOf, printerText, readPrinter } from "./printer.js";
import { knownPrinter } from "./printer-fixture.js";
import { report } from "./report-fixture.js";

const PRINTERS = (
  [
    ["jupiter", "Jupiter", "chitubox", ["ctb", "cxdlp"], false],
    ["shuffle", "Shuffle", "chitubox", ["zip"], true],
    ["sl1s", "SL1S", "sl1", ["sl1s"], true],
    ["saturn-3", "Saturn 3", "goo", ["goo"], true],
    ["mini-8k", "Mini 8K", "goo", ["prz"], true],
    ["photon-m5s", "Photon M5s", "photon-workshop", ["pm5s"], true],
    ["photon-m7", "Photon M7", "anycubic-zip", ["pm7"], true],
    ["saturn", "Saturn", "ctb", ["ctb"], true],
    ["athena", "Athena", "nanodlp", ["nanodlp"], true],
  ] as const
).map(([name, model, format, reads, reads_format]) => knownPrinter({ name, model, format, reads: [...reads], reads_format }));

test("the format is the printer's own if none is chosen", () => {
  expect(formatFor({ printer: "", format: "" }, PRINTERS)).toBe("png");
  expect(formatFor({ printer: "sl1s", format: "" }, PRINTERS)).toBe("sl1");
  expect(formatFor({ printer: "sl1s", format: "uvj" }, PRINTERS)).toBe("uvj");
});

const OWN_EXTENSIONS: Partial<Record<PrintFormat, string>> = { "photon-workshop": "pwmx", "anycubic-zip": "pwsz" };

test.each<[string, { printer?: string; format?: PrintFormat; taker?: string }, string]>([
  ["no printer", {}, "A zip of layer images."],
  ["no printer, a format", { format: "chitubox" }, "A ChiTuBox zip."],
  ["no printer, a printer's format", { format: "photon-workshop" }, "A .pwmx file."],
  ["one that needs a converter", { printer: "jupiter" }, "A ChiTuBox zip. The Jupiter reads .ctb or .cxdlp: convert it with UVtools first."],
  ["one that reads it", { printer: "shuffle" }, "A ChiTuBox zip. The Shuffle reads it directly."],
  ["one that reads another zip", { printer: "shuffle", format: "png" }, "A zip of layer images. The Shuffle cannot read it."],
  ["one that reads another file", { printer: "photon-m5s", format: "goo" }, "A .goo file. The Photon M5s reads .pm5s: convert it with UVtools first."],
  ["one that reads goo", { printer: "saturn-3" }, "A .goo file. The Saturn 3 reads it directly."],
  ["one that reads goo as prz", { printer: "mini-8k" }, "A .prz file. The Mini 8K reads it directly."],
  ["one that reads its own binary file", { printer: "photon-m5s" }, "A .pm5s file. The Photon M5s reads it directly."],
  ["one that reads its own zip", { printer: "photon-m7" }, "A .pm7 file. The Photon M7 reads it directly."],
  ["one that reads ctb", { printer: "saturn" }, "A .ctb file of version 3, not encrypted. The Saturn reads it directly."],
  ["one that reads nanodlp", { printer: "athena" }, "A .nanodlp file. The Athena reads it directly."],
  ["one that reads uniform layers", { printer: "sl1s" }, "A .sl1s file. The SL1S reads it directly."],
  [
    "one whose file has uniform layers alone",
    { printer: "sl1s", taker: "sl1" },
    "A .sl1s file. This file has one thickness for all layers: choose uniform ones for it.",
  ],
  [
    "one that prints uniform layers alone",
    { printer: "photon-m5s", taker: "Photon M5s" },
    "A .pm5s file. The Photon M5s takes one thickness for all layers: choose uniform ones for it.",
  ],
])("the line at the download, %s: what the file is and what it needs", (_name, options, said) => {
  const printer = PRINTERS.find(({ name }) => name === options.printer);
  const format = options.format ?? printer?.format ?? "png";
  const is_read_by_printer = printer?.reads_format === true && printer.format === format;
  const extension = (is_read_by_printer ? printer.reads[0] : OWN_EXTENSIONS[format]) ?? format;
  const print_file = { format, extension, media_type: "", is_read_by_printer };
  const { taker } = options;
  const warnings: Warning[] = taker === undefined ? [] : [{ code: "one-thickness", detail: { taker, best: null } }];
  const patch = { print_file, warnings, ...(printer !== undefined && { options: { printer: printer.name } }) };
  const words = (language: Language): string => fileWords({ report: report(patch) }, PRINTERS, language);
  expect(words(languageOf("en"))).toBe(`${said} The model prints unchanged: no supports, not hollowed.`);
  const others = LANGUAGES.map((code) => words(languageOf(code)));
  expect(new Set(others).size).toBe(LANGUAGES.length);
  for (const other of others) expect(other).not.toContain("undefined");
});

test.each<[PrintFormat, string]>([
  ["prusa-3mf", "A 3MF for PrusaSlicer. Set the first layer to 0.2\u00a0mm there (Print Settings → Layers and perimeters → First layer height)"],
  ["orca-3mf", "A 3MF for OrcaSlicer and Bambu Studio, untested there so far. Set the first layer to 0.2\u00a0mm there (Quality"],
])("the line at the download says what must match in the slicer of %s", (format, said) => {
  const filament = { slicers: ["PrusaSlicer"], nozzle_mm: 0.4, first_layer_mm: 0.2, is_tried: true };
  const print_file = { format, extension: "3mf", media_type: "model/3mf", is_read_by_printer: false, filament };
  const words = (language: Language): string => fileWords({ report: report({ print_file }) }, PRINTERS, language);
  expect(words(languageOf("en"))).toContain(said);
  const others = LANGUAGES.map((code) => words(languageOf(code)));
  expect(new Set(others).size).toBe(LANGUAGES.length);
  for (const other of others) expect(other).toMatch(/0[.,]2\u00a0mm/);
});

const MINE: Printer = { pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245], format: "goo", reads: ["goo"] };

test("a printer of one's own is meant by its description, whatever its name", () => {
  const namesake = { ...MINE, name: "saturn-3", model: "Mine" };
  expect(printerOf(namesake, PRINTERS)).toBe(namesake);
  expect(formatFor({ printer: namesake, format: "" }, PRINTERS)).toBe("goo");
  expect([printerOf("", PRINTERS), printerOf("neptune", PRINTERS), printerOf(undefined, PRINTERS)]).toEqual([null, null, null]);
  const print_file = { format: "goo", extension: "goo", media_type: "", is_read_by_printer: true } as const;
  const words = fileWords({ report: report({ print_file, options: { printer: namesake }, printer: "saturn-3" }) }, PRINTERS, languageOf("en"));
  expect(words).toMatch(/^A \.goo file\. The Mine reads it directly\./);
});

test.each<[string, unknown]>([
  ["no object", 7],
  ["null", null],
  ["a list", []],
  ["nothing in it", {}],
  ["no volume", { pixels: [1, 1], pitch_um: [50, 50] }],
  ["a pitch of zero", { ...MINE, pitch_um: [50, 0] }],
  ["three pixels", { ...MINE, pixels: [1, 2, 3] }],
  ["a limit that is no range", { ...MINE, layer_mm: 0.1 }],
  ["a format that there is not", { ...MINE, format: "zip" }],
  ["a model that is no text", { ...MINE, model: 7 }],
  ["extensions that are no list", { ...MINE, reads: "goo" }],
])("a description with %s is not shown; the core says what is wrong", (_name, value) => {
  expect(isPrinter(value)).toBe(false);
  expect(printerOf(value as Printer, PRINTERS)).toBeNull();
});

test("a file describes a printer, which has the file's name unless it says its own", async () => {
  const read = (text: string, name = "My printer.json"): Promise<Printer> => readPrinter(new File([text], name));
  expect(await read(JSON.stringify(MINE))).toEqual({ ...MINE, name: "My printer", model: "My printer" });
  expect(await read(JSON.stringify({ ...MINE, model: "Big One" }))).toMatchObject({ name: "My printer", model: "Big One" });
  // The core reports the missing fields.
  expect(await read("{}")).toEqual({ name: "My printer", model: "My printer" });
  for (const text of ["", "{", "[]", "null", '"saturn"', "7"]) {
    await expect(read(text), text).rejects.toMatchObject({ code: "printer-not-json", detail: { system: expect.stringMatching(/./) } });
  }
});

test("an address carries a description, unless it is very long or broken", () => {
  expect(printerFrom(printerText(MINE))).toEqual(MINE);
  expect(printerText("saturn")).toBe("saturn");
  expect(printerFrom("saturn")).toBe("saturn");
  expect(printerText({ ...MINE, model: "M".repeat(2000) })).toBe("");
  expect(printerFrom('{"pixels": [')).toBe("");
});

test("the line at the download of a hollow model does not say that it is solid", () => {
  const print_file = { format: "png", extension: "zip", media_type: "", is_read_by_printer: false } as const;
  const hollowed = { void_ml: 1, drains: [], resolution_mm: 0.25 };
  const words = (language: Language): string => fileWords({ report: report({ print_file, models: [{ hollowed } as unknown as ModelReport] }) }, PRINTERS, language);
  expect(words(languageOf("en"))).toMatch(/The model prints hollow: no supports\.$/);
  const others = LANGUAGES.map((code) => words(languageOf(code)));
  expect(new Set(others).size).toBe(LANGUAGES.length);
});
