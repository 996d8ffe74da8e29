/** The one table of the page's keys, as the list of keys shows it. */
import type { Tool } from "../view/scene/keys.js";

/** What a key does: see the texts. */
export type Does =
  | "keys" | "open" | "paste" | "undo" | "redo" | "cancel"
  | "turnView" | "zoom" | "whole" | "pickLayer"
  | "moveCopy" | "moveFar" | "turnCopy" | "turnCopyFar"
  | "turnModel" | "turnFinely" | "lay" | "paint" | "undoStroke" | "redoStroke"
  | "nextPoint" | "addPoint" | "removePoint" | "lockPoint"
  | "layer" | "layers" | "ends" | "zoomChart"
  | "move" | "direction" | "use";

/** Keys whose names are words. */
export type KeyName = "mod" | "shift" | "enter" | "escape" | "delete" | "backspace" | "pageUp" | "pageDown" | "home" | "end";

/** The tools of the view that place points: they have the same keys. */
type Placer = "supports" | "drains";

/** Where the keys work: with one of the view's tools, or elsewhere. */
export type Place = "everywhere" | Exclude<Tool, Placer> | "points" | "layers" | "mask" | "directions";

/** Keys that do one thing, as `KeyboardEvent.key` has them, after `Mod+` for Ctrl or ⌘, and `Shift+`; and a key held with all. */
export type Row = readonly [does: Does, keys: readonly string[], held?: "Shift"];

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"] as const;
const PAGES = ["PageUp", "PageDown"] as const;

const TURN_VIEW: Row = ["turnView", ARROWS];
const ZOOM: Row = ["zoom", ["+", "-"]];

/** The view's tools share the keys of the first: only what differs is listed for the others. */
export const KEY_TABLE: readonly (readonly [Place, readonly Row[]])[] = [
  [
    "everywhere",
    [
      ["keys", ["?"]],
      ["open", ["Mod+o"]],
      ["paste", ["Mod+v"]],
      ["undo", ["Mod+z"]],
      ["redo", ["Mod+Shift+z", "Mod+y"]],
      ["cancel", ["Escape"]],
    ],
  ],
  ["turn", [TURN_VIEW, ZOOM, ["whole", ["0"]], ["pickLayer", ["Enter"]]]],
  [
    "move",
    [
      ["moveCopy", ARROWS],
      ["moveFar", ARROWS, "Shift"],
      ["turnCopy", ["r"]],
      ["turnCopyFar", ["r"], "Shift"],
    ],
  ],
  [
    "rotate",
    [
      ["turnModel", [...ARROWS, ...PAGES]],
      ["turnFinely", [...ARROWS, ...PAGES], "Shift"],
    ],
  ],
  ["flat", [["lay", ["Enter"]]]],
  [
    "paint",
    [
      ["paint", ["Enter"]],
      ["undoStroke", ["Mod+z"]],
      ["redoStroke", ["Mod+Shift+z", "Mod+y"]],
    ],
  ],
  [
    "points",
    [
      ["nextPoint", ARROWS],
      ["turnView", ARROWS, "Shift"],
      ["addPoint", ["Enter"]],
      ["removePoint", ["Delete", "Backspace"]],
      ["lockPoint", ["l"]],
    ],
  ],
  [
    "layers",
    [
      ["layer", ["ArrowDown", "ArrowUp"]],
      ["layers", [...PAGES]],
      ["ends", ["Home", "End"]],
      ["zoomChart", ["+", "-", "0"]],
    ],
  ],
  ["mask", [ZOOM, ["move", ARROWS]]],
  ["directions", [["direction", ARROWS], ["use", ["Enter"]]]],
];

const GLYPHS: Readonly<Record<string, string>> = { ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", "-": "−" };

const NAMES: Readonly<Record<string, KeyName>> = {
  Mod: "mod",
  Shift: "shift",
  Enter: "enter",
  Escape: "escape",
  Delete: "delete",
  Backspace: "backspace",
  PageUp: "pageUp",
  PageDown: "pageDown",
  Home: "home",
  End: "end",
};

/** The caps of a key of the table: `Mod+z` as Ctrl and Z. */
export function caps(key: string, names: Readonly<Record<KeyName, string>>, isMac: boolean): string[] {
  return key.split(/\+(?=.)/).map((part) => {
    const name = NAMES[part];
    if (name === "mod" && isMac) return "⌘";
    return name === undefined ? (GLYPHS[part] ?? part.toUpperCase()) : names[name];
  });
}
