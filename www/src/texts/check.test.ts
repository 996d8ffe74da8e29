import { expect, test } from "vitest";
import { english, faultsOf, LANGUAGES, untranslated } from "./check.js";
import type { Dictionary } from "./messages.js";

const dictionaries = import.meta.glob<Dictionary>("./*.json", { eager: true, import: "default" });

test("English names formats that there are", () => {
  expect(faultsOf("English", english)).toEqual([]);
});

test.each(Object.entries(dictionaries))("the dictionary fits the English messages: %s", (file, dictionary) => {
  expect(faultsOf(file, dictionary)).toEqual([]);
  const missing = untranslated(dictionary).length;
  if (missing > 0) console.info(`${file}: ${missing} messages are not translated`);
});

test("each language but English has a dictionary", () => {
  const codes = Object.keys(dictionaries).map((file) => file.slice("./".length, -".json".length));
  expect(new Set(["en", ...codes])).toEqual(new Set(LANGUAGES));
});

test("a fault is named with its file and key", () => {
  const faulty = {
    "plan.nothing": "Nichts",
    "plan.resin": "ungefähr {menge} Harz",
    "plan.own": "",
    "errors.bad-height": "Die Höhe ist {height_mm|metres}.",
    "plan.price": "Preis",
  };
  expect(faultsOf("xx.json", faulty)).toEqual([
    "xx.json: plan.nothing: English has no such key",
    "xx.json: plan.resin: the placeholders are menge, not ml",
    "xx.json: plan.own: the text is empty",
    "xx.json: errors.bad-height: there is no format metres",
  ]);
  expect(untranslated(faulty)).toContain("plan.region");
});
