/** Compares the tables of docs/embed.md with the element's own lists. */
import { readFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { expect, test } from "vitest";
import { FORMATS } from "../api/facts.js";
import { LANGUAGES } from "../texts/index.js";
import { PROPERTIES, READ_ONLY, SETTING_NAMES } from "./properties.js";
import { METRIC_NAMES } from "./state/metric.js";
import { PANELS } from "./state/panel-names.js";

const textOf = (path: string): Promise<string> => readFile(fileURLToPath(new URL(path, import.meta.url)), "utf8");

const guide = await textOf("../../../docs/embed.md");

/** Rows of the table under a heading, split into cells. */
function rowsOf(heading: string): string[][] {
  const [, table = ""] = guide.split(`| ${heading} |`);
  const lines = table.split("\n").slice(2);
  const end = lines.findIndex((line) => !line.startsWith("|"));
  return lines.slice(0, end).map((line) => line.split("|").slice(1, -1).map((cell) => cell.trim()));
}

/** Texts between backticks in a cell. */
const codesIn = (cell = ""): string[] => [...cell.matchAll(/`([^`]+)`/g)].map(([, code = ""]) => code);

const rows = rowsOf("attribute | property |");

test("the guide has a row for every property, with its attribute", () => {
  const told = rows.flatMap(([attributes, properties]) => {
    const names = codesIn(attributes);
    return codesIn(properties).map((property, i) => [property, names[i] ?? null] as const);
  });
  const known = [
    ...Object.entries(PROPERTIES).map(([property, it]) => [property, it?.attribute ?? null] as const),
    ...READ_ONLY.map((property) => [property, property === "state" ? "state" : null] as const),
  ];
  expect(new Map(told)).toEqual(new Map(known));
  expect(told).toHaveLength(known.length);
});

test.each([
  ["metric", METRIC_NAMES],
  ["format", FORMATS],
  ["panels", PANELS],
  ["fixed", SETTING_NAMES],
])("the guide lists all values of %s", (attribute, known) => {
  const row = rows.find(([attributes]) => codesIn(attributes).includes(attribute));
  const told = codesIn(row?.[2]).flatMap((code) => code.split(" "));
  expect(told.toSorted()).toEqual([...known].toSorted());
});

test("the guide names the languages", () => {
  const row = rows.find(([attributes]) => codesIn(attributes).includes("locale"));
  expect(LANGUAGES.filter((language) => !new RegExp(`\\b${language}\\b`).test(row?.[2] ?? ""))).toEqual([]);
});

test("the guide has a row for every event", async () => {
  const events = [...(await textOf("./events.ts")).matchAll(/^ {2}"(cusp-[a-z]+)": CustomEvent</gm)].map(([, name]) => name);
  expect(events.length).toBeGreaterThan(0);
  expect(rowsOf("event | `detail`").flatMap(([name]) => codesIn(name)).toSorted()).toEqual(events.toSorted());
});
