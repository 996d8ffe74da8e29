import { readFile } from "node:fs/promises";
import { expect, test } from "vitest";
import { FORMATS } from "../src/api/facts.js";
import { PROPERTIES, READ_ONLY } from "../src/element/properties.js";
import { reference } from "./reference.js";

const text = await reference();
const sourceOf = (path: string): Promise<string> => readFile(new URL(`../src/${path}`, import.meta.url), "utf8");

/** First cells of the rows under a heading. */
function namesUnder(heading: string): string[] {
  const [, rest = ""] = text.split(`## ${heading}\n`);
  const rows = rest.split("\n## ")[0]?.split("\n") ?? [];
  return rows.flatMap((line) => /^\| `([\w-]+)/.exec(line)?.[1] ?? []);
}

/** Names in the body of an interface, whether they have a comment or not. */
async function namesIn(path: string, interfaceName: string): Promise<string[]> {
  const source = await sourceOf(path);
  const [, body = ""] = source.split(`export interface ${interfaceName} {\n`);
  return [...(body.split("\n}")[0] ?? "").matchAll(/^ {2}"?([a-z][\w-]*)"?[(:]/gm)].map(([, name = ""]) => name);
}

test("every property has a row with its attribute, type and meaning", () => {
  const attributes = { ...Object.fromEntries(Object.entries(PROPERTIES).map(([name, it]) => [name, it?.attribute])), ...Object.fromEntries(READ_ONLY.map((name) => [name, name === "state" ? name : undefined])) };
  for (const [name, attribute] of Object.entries(attributes)) {
    const row = text.split("\n").find((line) => line.startsWith(`| ${attribute === undefined ? "" : `\`${attribute}\``} | \`${name}\` |`));
    expect(row, name).toMatch(/ \| `.+` \| .+\. \|$/);
  }
});

test("values and defaults are those of the core", () => {
  expect(text).toContain(FORMATS.map((format) => `\`${format}\``).join(", "));
  expect(text).toMatch(/`layerMin` .* Default: 0\.05\. \|/);
});

test("every event and every method has a row", async () => {
  expect(namesUnder("Events")).toEqual(await namesIn("element/events.ts", "CuspSlicerEvents"));
  expect(namesUnder("The headless slicer")).toEqual(await namesIn("api/index.ts", "Slicer"));
  expect(namesUnder("Methods").toSorted()).toEqual(["add", "cancel", "export", "load", "plan", "redo", "thumbnail", "undo"]);
});
