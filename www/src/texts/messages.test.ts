import { expect, test } from "vitest";
import { FORMAT_WORDS, formatOf } from "./format.js";
import { ENGLISH, room, say, type Spoken } from "./messages.js";

const dictionary: Record<string, string> = { "test.copies": "{count|one:une copie|other:# copies} en {unit|test.units}", "test.units.inch": "pouces" };
const spoken = (locale: string, own: Record<string, string>): Spoken => ({
  format: formatOf(locale, FORMAT_WORDS),
  message: (key) => own[key] ?? ENGLISH.get(key),
});
const english = spoken("en", {});
const french = spoken("fr", dictionary);

const texts = room("test", {
  title: "Copies",
  copies: "{count|one:one copy|other:# copies} in {unit|test.units}",
  units: { inch: "inches", foot: "feet" },
  steps: [["One", "Begin with {name}."]],
});

test("a number chooses the form of its language, and a value its noun", () => {
  expect([1, 1200].map((count) => texts(english).copies({ count, unit: "foot" }))).toEqual(["one copy in feet", "1,200 copies in feet"]);
  expect(texts(french).copies({ count: 0, unit: "inch" })).toBe("une copie en pouces");
});

test("English replaces a message that a dictionary lacks", () => {
  expect(texts(french).title).toBe("Copies");
  expect(texts(french).copies({ count: 2, unit: "foot" })).toBe("2 copies en feet");
  expect(texts(french).steps[0][1]({ name: "{name}" })).toBe("Begin with {name}.");
});

test("texts that are in use get the messages that arrive later", () => {
  const own: Record<string, string> = {};
  const { units } = texts(spoken("de", own));
  expect(units.inch).toBe("inches");
  own["test.units.inch"] = "Zoll";
  expect({ ...units }).toEqual({ inch: "Zoll", foot: "feet" });
});

test("fields, lists and formats of values", () => {
  ENGLISH.set("test.found", "{best.layer_mm|mm} of {known}: {size_mm|exact}; {size_mm.1|count}");
  const values = { best: { layer_mm: 0.05 }, known: ["a", "b"], size_mm: [0.5, 2] };
  expect(say("test.found", values, english)).toBe("0.05\u00a0mm of a, b: 0.5, 2; 2");
});

test("the compiler names a missing and a surplus value", () => {
  // @ts-expect-error unit is missing
  expect(texts(english).copies({ count: 1 })).toBe("one copy in undefined");
  // @ts-expect-error there is no place
  expect(texts(english).steps[0][1]({ name: "a", place: "b" })).toBe("Begin with a.");
});
