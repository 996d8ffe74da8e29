/** Maps keys to actions of the view. */
import { places } from "./places.js";

/** Meaning of pointer input in the view. */
export type Tool = "turn" | "move" | "rotate" | "size" | "flat" | "paint" | "supports" | "drains";

export type Action =
  | { readonly do: "turn-view"; readonly right_deg: number; readonly up_deg: number }
  | { readonly do: "move-copy"; readonly x_mm: number; readonly y_mm: number; readonly turn_deg: number }
  | { readonly do: "turn-model"; readonly axis: "x" | "y" | "z"; readonly degrees: number }
  | { readonly do: "size-model"; readonly factor: number }
  | { readonly do: "duplicate" | "remove-copies" | "menu" }
  | { readonly do: "zoom"; readonly factor: number }
  | { readonly do: "reset" }
  | { readonly do: "pick-middle" }
  | { readonly do: "next-point"; readonly by: 1 | -1 }
  | { readonly do: "remove-point" | "lock-point" }
  | { readonly do: "undo-stroke" | "redo-stroke" };

/** Degrees per key press for turning the view. */
const VIEW_DEG = 10;

/** Degrees per key press for turning the model, without and with Shift. */
const MODEL_DEG = 5;
const MODEL_FINE_DEG = 1;

/** Millimetres per key press for moving a copy, without and with Shift, and degrees for turning it. */
const MOVE_MM = 1;
const MOVE_FAR_MM = 10;
const COPY_DEG = 15;
const COPY_FAR_DEG = 45;

/** Factors per key press for the size of the model, without and with Shift. */
const SIZE = 1.01;
const SIZE_FAR = 1.1;

const ZOOM = 1.2;

/** Turning direction of each key: across, up, and about the third axis. */
const WAYS: Readonly<Record<string, readonly [number, number, number]>> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

/** Action of a key with this tool; null for keys left to the page. */
export function pressed(
  { key, shiftKey, ctrlKey, metaKey, altKey }: Pick<KeyboardEvent, "key" | "shiftKey" | "ctrlKey" | "metaKey" | "altKey">,
  tool: Tool,
): Action | null {
  if (tool === "paint" && (ctrlKey || metaKey) && !altKey) {
    if (key.toLowerCase() === "z") return { do: shiftKey ? "redo-stroke" : "undo-stroke" };
    if (key.toLowerCase() === "y") return { do: "redo-stroke" };
  }
  if ((ctrlKey || metaKey) && !altKey && !shiftKey && key.toLowerCase() === "d" && !places(tool)) return { do: "duplicate" };
  if (ctrlKey || metaKey || altKey) return null;
  if (key === "ContextMenu" || (key === "F10" && shiftKey)) return { do: "menu" };
  if (key === "+" || key === "=") return { do: "zoom", factor: ZOOM };
  if (key === "-") return { do: "zoom", factor: 1 / ZOOM };
  if (key === "0") return { do: "reset" };
  if (key === "Enter") return { do: "pick-middle" };
  if (tool === "move" && key.toLowerCase() === "r") {
    return { do: "move-copy", x_mm: 0, y_mm: 0, turn_deg: shiftKey ? COPY_FAR_DEG : COPY_DEG };
  }
  if (places(tool)) {
    if (key === "Delete" || key === "Backspace") return { do: "remove-point" };
    if (key.toLowerCase() === "l") return { do: "lock-point" };
  } else if (key === "Delete" && tool !== "paint") return { do: "remove-copies" };
  const way = WAYS[key];
  if (way === undefined) return null;
  const [across, up, third] = way;
  if (tool === "move" && third === 0) {
    const mm = shiftKey ? MOVE_FAR_MM : MOVE_MM;
    return { do: "move-copy", x_mm: across * mm, y_mm: up * mm, turn_deg: 0 };
  }
  if (places(tool) && third === 0 && !shiftKey) return { do: "next-point", by: across - up > 0 ? 1 : -1 };
  if (tool === "size" && third === 0) {
    const factor = shiftKey ? SIZE_FAR : SIZE;
    return { do: "size-model", factor: across + up > 0 ? factor : 1 / factor };
  }
  if (tool !== "rotate") return third === 0 ? { do: "turn-view", right_deg: VIEW_DEG * across, up_deg: VIEW_DEG * up } : null;
  const degrees = shiftKey ? MODEL_FINE_DEG : MODEL_DEG;
  if (across !== 0) return { do: "turn-model", axis: "z", degrees: across * degrees };
  if (up !== 0) return { do: "turn-model", axis: "x", degrees: -up * degrees };
  return { do: "turn-model", axis: "y", degrees: third * degrees };
}
