import { afterEach, expect, test, vi } from "vitest";
import { watchGestures } from "../element/gestures.js";
import { pressed, type Tool } from "../view/scene/keys.js";
import { places } from "../view/scene/places.js";
import { caps, KEY_TABLE, type Place } from "./key-table.js";
import { languageOf } from "../texts/index.js";
import { visitWords } from "./visit-texts.js";

const words = visitWords(languageOf("en"));

afterEach(() => vi.unstubAllGlobals());

/** Every key of an ordinary keyboard, alone and with modifiers, named as in the table. */
const PRINTABLE = Array.from({ length: 94 }, (_, i) => String.fromCharCode(33 + i)).filter((key) => !/[A-Z]/.test(key));
const NAMED = ["Arrow", "Page"].flatMap((kind) => ["Left", "Right", "Up", "Down"].map((way) => kind + way));
const OTHERS = ["Enter", "Escape", "Tab", " ", "Home", "End", "Insert", "Delete", "Backspace", "F1", "F2", "F10"];
const HELD = ["", "Mod+", "Shift+", "Mod+Shift+"];

const presses = [...PRINTABLE, ...NAMED, ...OTHERS].flatMap((key) =>
  HELD.map((held) => ({
    name: held + key,
    event: { key, ctrlKey: held.includes("Mod"), shiftKey: held.includes("Shift"), metaKey: false, altKey: false },
  })),
);

const listed = (place: Place): string[] =>
  KEY_TABLE.filter(([at]) => at === place).flatMap(([, rows]) =>
    rows.flatMap(([, keys, held]) => keys.map((key) => (held === undefined ? key : `${held}+${key}`))),
  );

/** Name of a key press in the table: `=` is on the key of `+`, and Shift counts only if it makes a difference. */
const same = (name: string, tool: Tool | null): string => {
  const key = name.replace(/=$/, "+").replace("Mod+Shift+y", "Mod+y").replace(/^.*Escape$/, "Escape");
  const counts =
    (tool === "rotate" && /Arrow|Page/.test(key)) ||
    (tool === "size" && /Arrow/.test(key)) ||
    key.endsWith("F10") ||
    (tool === "move" && /Arrow|^(Shift\+)?r$/.test(key)) ||
    (tool !== null && places(tool) && key.includes("Arrow"));
  return counts ? key : key.replace(/^Shift\+/, "");
};

test.each([
  ["turn", "turn"],
  ["move", "move"],
  ["rotate", "rotate"],
  ["size", "size"],
  ["flat", "flat"],
  ["paint", "paint"],
  ["supports", "points"],
  ["drains", "points"],
] as const)("the list names every key of the view: %s", (tool, place) => {
  const names = new Set([...listed("turn"), ...listed(place)]);
  const found = new Set(presses.filter(({ event }) => pressed(event, tool) !== null).map(({ name }) => same(name, tool)));
  expect([...found].filter((name) => !names.has(name))).toEqual([]);
  // All listed keys have an effect.
  expect(listed(place).filter((name) => !found.has(name))).toEqual([]);
});

test("the list names every key of the element", () => {
  vi.stubGlobal("HTMLInputElement", class {});
  const element = new EventTarget();
  const acted: string[] = [];
  const note = (what: string) => (): void => void acted.push(what);
  watchGestures(element as HTMLElement, {
    dragging: note("dragging"),
    open: note("open"),
    refuse: note("refuse"),
    cancel: note("cancel"),
    undo: note("undo"),
    redo: note("redo"),
  });
  const names = new Set(listed("everywhere"));
  const found = new Set<string>();
  for (const { name, event } of presses) {
    acted.length = 0;
    element.dispatchEvent(Object.assign(new Event("keydown"), event, { composedPath: () => [element] }));
    if (acted.length > 0) found.add(same(name, null));
  }
  expect([...found].filter((name) => !names.has(name))).toEqual([]);
  expect(["Mod+z", "Mod+y", "Mod+Shift+z", "Escape"].filter((name) => !found.has(name))).toEqual([]);
});

test("keys have caps as on the person's keyboard", () => {
  expect(caps("Mod+Shift+z", words.keys.names, false)).toEqual(["Ctrl", "Shift", "Z"]);
  expect(caps("Mod+z", words.keys.names, true)).toEqual(["⌘", "Z"]);
  expect(caps("Shift+ArrowLeft", words.keys.names, false)).toEqual(["Shift", "←"]);
  expect(caps("+", words.keys.names, false)).toEqual(["+"]);
  expect(caps("-", words.keys.names, false)).toEqual(["−"]);
});
