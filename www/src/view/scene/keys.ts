/** Maps keys to actions of the view. */

/** What the pointer does. */
export type Tool = "turn" | "rotate" | "flat" | "paint";

export type Action =
  | { readonly do: "turn-view"; readonly right_deg: number; readonly up_deg: number }
  | { readonly do: "turn-model"; readonly axis: "x" | "y" | "z"; readonly degrees: number }
  | { readonly do: "zoom"; readonly factor: number }
  | { readonly do: "reset" }
  | { readonly do: "pick-middle" }
  | { readonly do: "undo-stroke" | "redo-stroke" };

/** Degrees by which a key press turns the view. */
const VIEW_DEG = 10;

/** Degrees by which a key press turns the model, without and with Shift. */
const MODEL_DEG = 5;
const MODEL_FINE_DEG = 1;

const ZOOM = 1.2;

/** Which way each key turns: across, up, and about the third axis. */
const WAYS: Readonly<Record<string, readonly [number, number, number]>> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

/** The action of a key with this tool; null for keys left to the page. */
export function pressed(
  { key, shiftKey, ctrlKey, metaKey, altKey }: Pick<KeyboardEvent, "key" | "shiftKey" | "ctrlKey" | "metaKey" | "altKey">,
  tool: Tool,
): Action | null {
  if (tool === "paint" && (ctrlKey || metaKey) && !altKey) {
    if (key.toLowerCase() === "z") return { do: shiftKey ? "redo-stroke" : "undo-stroke" };
    if (key.toLowerCase() === "y") return { do: "redo-stroke" };
  }
  if (ctrlKey || metaKey || altKey) return null;
  if (key === "+" || key === "=") return { do: "zoom", factor: ZOOM };
  if (key === "-") return { do: "zoom", factor: 1 / ZOOM };
  if (key === "0") return { do: "reset" };
  if (key === "Enter") return { do: "pick-middle" };
  const way = WAYS[key];
  if (way === undefined) return null;
  const [across, up, third] = way;
  if (tool !== "rotate") return third === 0 ? { do: "turn-view", right_deg: VIEW_DEG * across, up_deg: VIEW_DEG * up } : null;
  const degrees = shiftKey ? MODEL_FINE_DEG : MODEL_DEG;
  if (across !== 0) return { do: "turn-model", axis: "z", degrees: across * degrees };
  if (up !== 0) return { do: "turn-model", axis: "x", degrees: -up * degrees };
  return { do: "turn-model", axis: "y", degrees: third * degrees };
}
