import { beforeEach, expect, test } from "vitest";
import { takeDrop } from "./dropped.js";

/** A folder as an object of entries by name; null for a file. */
interface Tree {
  readonly [name: string]: Tree | null;
}

const entryOf = (name: string, tree: Tree | null): unknown => {
  if (tree === null) return { name, isDirectory: false, file: (resolve: (file: File) => void) => resolve(new File([], name)) };
  const parts = Object.entries(tree).map(([name, part]) => entryOf(name, part));
  // Browsers return up to a hundred at a time, this fake one.
  const createReader = (): unknown => {
    const left = [...parts];
    return { readEntries: (resolve: (entries: unknown[]) => void) => resolve(left.splice(0, 1)) };
  };
  return { name, isDirectory: true, createReader };
};

/** Fake transfer that behaves as in browsers: it is readable only during the event, and lists folders among the files. */
function drop(tree: Tree, link = ""): DataTransfer {
  const items = Object.entries(tree).map(([name, part]) => ({ kind: "file", webkitGetAsEntry: () => entryOf(name, part), getAsFile: () => new File([], name) }));
  const strings = link === "" ? [] : [{ kind: "string", webkitGetAsEntry: () => null, getAsFile: () => null }];
  const files = Object.keys(tree).map((name) => new File([], name));
  return { items: [...items, ...strings], files, getData: () => link } as unknown as DataTransfer;
}

let told: unknown[];

beforeEach(() => {
  told = [];
});

async function taken(transfer: DataTransfer | null): Promise<unknown[]> {
  takeDrop(transfer, { open: (files) => void told.push(files.map(({ name }) => name)), refuse: ({ code }, name) => void told.push([code, name]) });
  await new Promise((resolve) => setTimeout(resolve));
  return told;
}

test("files are opened as they are, whatever their names, at once", async () => {
  void taken(drop({ "a.stl": null, notes: null }, "file:///a.stl"));
  expect(told).toEqual([["a.stl", "notes"]]);
});

test("a folder stands for the models in it and in its folders, beside the files that were dropped with it", async () => {
  const parts = { "b 10.stl": null, "b 9.OBJ": null, LICENSE: null, "view.png": null, more: { "c.3mf": null, none: {} } };
  expect(await taken(drop({ parts, "a.stl": null }))).toEqual([["a.stl", "b 9.OBJ", "b 10.stl", "c.3mf"]]);
});

test("a folder without a model is refused, as is one that cannot be read", async () => {
  expect(await taken(drop({ pictures: { "a.png": null, README: null } }))).toEqual([["folder-without-model", "pictures"]]);
  const createReader = (): unknown => ({ readEntries: (_: unknown, reject: (cause: unknown) => void) => reject(new Error("no")) });
  const locked = { items: [{ kind: "file", webkitGetAsEntry: () => ({ name: "locked", isDirectory: true, createReader }), getAsFile: () => null }], files: [] };
  expect(await taken(locked as unknown as DataTransfer)).toContainEqual(["file-unreadable", "locked"]);
});

test("a link is refused with its host, however long it is; text and nothing at all are left alone", async () => {
  expect(await taken(drop({}, "https://models.example/thing?id=1\r\n"))).toEqual([["dropped-link", "models.example"]]);
  expect(await taken(drop({}, `data:image/png;base64,${"A".repeat(1e5)}`))).toContainEqual(["dropped-link", "data:"]);
  for (const transfer of [drop({}, "no link"), drop({}), null]) await taken(transfer);
  expect(told).toHaveLength(2);
});
