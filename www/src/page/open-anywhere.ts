/** Accepts dropped and pasted files anywhere on the page, and Escape, undo and redo from any focus. */
import { takeDrop } from "../element/dropped.js";
import { pressed, type Gestures } from "../element/gestures.js";

/** Selector of the place where a drop replaces the open models. Elsewhere it is added to them. */
const REPLACING = ".drop-veil .replace";

export interface Anywhere extends Gestures {
  open(files: readonly File[], isReplacing?: boolean): void;
}

const replacing = (): Element | null => document.querySelector(REPLACING);

/** Tells by the position, since a veil that takes events would change the target under the pointer. */
function isReplacing({ clientX, clientY }: DragEvent): boolean {
  const { left, right, top, bottom } = replacing()?.getBoundingClientRect() ?? new DOMRect();
  return clientX > left && clientX < right && clientY > top && clientY < bottom;
}

export function openAnywhere(anywhere: Anywhere): void {
  const { dragging, open } = anywhere;
  // Captures events before the element, to avoid handling a drop twice. A drop outside the element must not navigate away.
  window.addEventListener(
    "dragover",
    (event) => {
      event.preventDefault();
      dragging(event.dataTransfer?.types.includes("Files") ?? false);
      replacing()?.classList.toggle("over", isReplacing(event));
      event.stopPropagation();
    },
    { capture: true },
  );
  window.addEventListener("dragleave", (event) => {
    // A move between elements of the page has a related target.
    if (event.relatedTarget === null) dragging(false);
  });
  window.addEventListener(
    "drop",
    (event) => {
      event.preventDefault();
      event.stopPropagation();
      const isOver = isReplacing(event);
      dragging(false);
      takeDrop(event.dataTransfer, { ...anywhere, open: (files) => open(files, isOver) });
    },
    { capture: true },
  );
  window.addEventListener("paste", (event) => {
    if (!event.defaultPrevented) open([...(event.clipboardData?.files ?? [])]);
  });
  window.addEventListener("keydown", (event) => {
    // The element has handled its own.
    if (!event.defaultPrevented) pressed(event, anywhere);
  });
}
