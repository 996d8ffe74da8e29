/** Gestures on the whole element: dropping and pasting files, and keyboard shortcuts. */
import { takeDrop, type DropHost } from "./dropped.js";

export interface Gestures extends DropHost {
  /** Called when files are dragged over the element, and when they leave it. */
  dragging(isOver: boolean): void;
  cancel(): void;
  undo(): void;
  redo(): void;
}

export function watchGestures(element: HTMLElement, gestures: Gestures): void {
  element.addEventListener("dragover", (event) => {
    event.preventDefault();
    gestures.dragging(event.dataTransfer?.types.includes("Files") ?? false);
  });
  element.addEventListener("dragleave", () => gestures.dragging(false));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    gestures.dragging(false);
    takeDrop(event.dataTransfer, gestures);
  });
  element.addEventListener("paste", (event) => {
    const files = [...(event.clipboardData?.files ?? [])];
    if (files.length === 0) return;
    event.preventDefault();
    gestures.open(files);
  });
  element.addEventListener("keydown", (event) => pressed(event, gestures));
}

/** Handles Escape, undo and redo. */
export function pressed(event: KeyboardEvent, { cancel, undo, redo }: Pick<Gestures, "cancel" | "undo" | "redo">): void {
  if (event.key === "Escape") return cancel();
  const [origin] = event.composedPath();
  // In a text field, the browser handles these keys.
  if (!(event.ctrlKey || event.metaKey) || (origin instanceof HTMLInputElement && origin.type === "text")) return;
  const key = event.key.toLowerCase();
  if (key === "y" || (key === "z" && event.shiftKey)) redo();
  else if (key === "z") undo();
  else return;
  event.preventDefault();
}
