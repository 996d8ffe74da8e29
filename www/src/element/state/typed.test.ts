import { expect, test } from "vitest";
import { languageOf, LANGUAGES } from "../../texts/index.js";
import { canonical, localised, read, UNITS_SHOWN, type FieldUnit } from "./typed.js";

const mark = (code: string): string => languageOf(code).format.decimal;

test("each language has its own decimal mark", () => {
  expect(LANGUAGES.map((code) => code + mark(code))).toEqual(["en.", "de,", "es,", "fr,", "zh."]);
  expect([mark("es-MX"), mark("de-CH")]).toEqual([".", "."]);
});

test.each([
  ["0.05", "0.05"],
  [" 0,05 ", "0.05"],
  [".5", "0.5"],
  ["12.", "12"],
  ["0.050", "0.05"],
  ["50 µm", "0.05"],
  ["50 μm", "0.05"],
  ["50um", "0.05"],
  ["50\u202fUM", "0.05"],
  ["71\u00a0µ", "0.071"],
  ["35 microns", "0.035"],
  ["0.05 mm", "0.05"],
  ["0,05mm", "0.05"],
  ["0,05\u2009MM", "0.05"],
  ["2 thou", "0.0508"],
  ["2 mil", "0.0508"],
  ["0.002 in", "0.0508"],
  ['1"', "25.4"],
  ["1″", "25.4"],
  ["5 cm", "50"],
  ["０．０５", "0.05"],
  ["0.05 ㎜", "0.05"],
])("%j in a field of millimetres is %s", (text, value) => {
  expect(canonical(text, "mm", ".")).toBe(value);
});

test.each([
  ["2.5 s", "s", "2.5"],
  ["2500 ms", "s", "2.5"],
  ["1 min", "s", "60"],
  ["0,5MIN", "s", "30"],
  ["5 %", "%", "5"],
  ["5％", "%", "5"],
  ["1.5 mm³", "mm³", "1.5"],
  ["1,5mm3", "mm³", "1.5"],
  ["2 mm^3", "mm³", "2"],
  ["30°", "°", "30"],
  ["6", "", "6"],
] as const)("%j in a field of %s is %s", (text, unit, value) => {
  expect(canonical(text, unit, ".")).toBe(value);
});

test.each([
  ["5 mm", "s"],
  ["5 mm³", "mm"],
  ["5²", "mm"],
  ["5 %", "mm"],
  ["2 s", "%"],
  ["50 µm", "mm³"],
  ["5 apples", "mm"],
  ["1e3", "mm"],
  ["2½", "mm"],
] as const)("%j has a unit that is none of a field of %s", (text, unit) => {
  expect(read(text, unit, ".").fault).toBe("unit");
});

test.each(["", " ", "mm", "-1", "+1", "1,2,3", "1.5.5", "1 50", "abc", ".", "5'", "Infinity"])("%j is no number", (text) => {
  expect(read(text, "mm", ".").fault).toBe("number");
  expect(read("6 layers", "", ".").fault).toBe("number");
});

test.each([
  // Two marks, or one that is never a decimal mark.
  ["1.000,5", ".,"],
  ["1,000.5", ".,"],
  ["1,000,000", ".,"],
  ["1 000", ".,"],
  ["12\u202f345,5", ".,"],
  ["1'000", ".,"],
  // One mark before three digits: a thousand or one, by language.
  ["1,000", "."],
  ["1.000", ","],
  ["12.345 µm", ","],
])("%j separates thousands where the decimal mark is among %s", (text, marks) => {
  for (const decimal of marks) {
    expect(read(text, "mm", decimal).fault).toBe("grouped");
    // The stored text is not a number in any language either.
    for (const other of [".", ",", undefined]) expect(read(canonical(text, "mm", decimal), "mm", other).fault).toBe("grouped");
  }
});

test.each([
  ["1.000", ".", 1],
  ["1,000", ",", 1],
  ["0.065", ",", 0.065],
  ["0,065", ".", 0.065],
  [",065", ".", 0.065],
  ["1234,567", ".", 1234.567],
  ["1,5", ".", 1.5],
  ["1,0000", ".", 1],
])("%j where the mark is %j cannot be thousands: it is %d", (text, decimal, value) => {
  expect(read(text, "mm", decimal).value).toBe(value);
});

test("a field shows a canonical number with the mark of its language, which gives the same number again", () => {
  for (const decimal of [".", ","]) {
    for (const text of ["0.065", "12.345", "1000", "0", ".5", "12."]) {
      expect(read(localised(text, decimal), "mm", decimal).value).toBe(Number(text));
    }
  }
  expect(localised("0.065", ",")).toBe("0,065");
  expect(["", "5 s", "1 000", "x.y"].map((text) => localised(text, ","))).toEqual(["", "5 s", "1 000", "x.y"]);
});

test("canonical numbers are short, and plain however small or large", () => {
  expect(["65 um", "7 thou", "0.0000001", "123456789012"].map((text) => canonical(text, "mm"))).toEqual(["0.065", "0.1778", "0.0000001", "123456789012"]);
});

test("the units that a fault names are those that are read", () => {
  for (const [unit, names] of Object.entries(UNITS_SHOWN)) {
    for (const name of names) expect(read(`2 ${name}`, unit as FieldUnit).fault, name).toBeNull();
  }
});
