/** Table of the page's keys, as shown in the list of keys. */
import type { Tool } from "../view/scene/keys.js";

/** Effects of keys, described in the texts. */
export type Does =
  | "keys" | "open" | "paste" | "undo" | "redo" | "cancel"
  | "turnView" | "zoom" | "whole" | "pickLayer"
  | "menu" | "duplicate" | "removeCopies" | "sizeModel" | "sizeFar"
  | "moveCopy" | "moveFar" | "turnCopy" | "turnCopyFar"
  | "turnModel" | "turnFinely" | "lay" | "paint" | "undoStroke" | "redoStroke"
  | "nextPoint" | "addPoint" | "removePoint" | "lockPoint"
  | "layer" | "layers" | "ends" | "zoomChart"
  | "move" | "direction" | "use";

/** Keys named by words. */
export type KeyName = "mod" | "shift" | "enter" | "escape" | "delete" | "backspace" | "pageUp" | "pageDown" | "home" | "end";

/** Tools that place points; they share their keys. */
type Placer = "supports" | "drains";

/** Context in which keys work: one of the view's tools, or another part of the page. */
export type Place = "everywhere" | Exclude<Tool, Placer> | "points" | "layers" | "mask" | "directions";

/** Keys with one effect, as in `KeyboardEvent.key`, after `Mod+` for Ctrl or ⌘, and `Shift+`; and a key to hold with all of them. */
export type Row = readonly [does: Does, keys: readonly string[], held?: "Shift"];

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"] as const;
const PAGES = ["PageUp", "PageDown"] as const;

const TURN_VIEW: Row = ["turnView", ARROWS];
const ZOOM: Row = ["zoom", ["+", "-"]];

/** The view's tools share the keys of the first; for the others, only differences are listed. */
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
  ["turn", [TURN_VIEW, ZOOM, ["whole", ["0"]], ["pickLayer", ["Enter"]], ["menu", ["Shift+F10"]], ["duplicate", ["Mod+d"]], ["removeCopies", ["Delete"]]]],
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
  [
    "size",
    [
      ["sizeModel", ARROWS],
      ["sizeFar", ARROWS, "Shift"],
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

/** Key caps of a key of the table: Ctrl and Z for `Mod+z`. */
export function caps(key: string, names: Readonly<Record<KeyName, string>>, isMac: boolean): string[] {
  return key.split(/\+(?=.)/).map((part) => {
    const name = NAMES[part];
    if (name === "mod" && isMac) return "⌘";
    return name === undefined ? (GLYPHS[part] ?? part.toUpperCase()) : names[name];
  });
}
