/** Accepts dropped and pasted files anywhere on the page, and Escape from any focus. */
import { takeDrop, type DropHost } from "../element/dropped.js";

export interface Anywhere extends DropHost {
  dragging(is: boolean): void;
  cancel(): void;
}

export function openAnywhere(anywhere: Anywhere): void {
  const { dragging, open, cancel } = anywhere;
  // Captures events before the element, to avoid handling a drop twice. A drop outside the element must not navigate away.
  window.addEventListener(
    "dragover",
    (event) => {
      event.preventDefault();
      dragging(event.dataTransfer?.types.includes("Files") ?? false);
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
      dragging(false);
      takeDrop(event.dataTransfer, anywhere);
    },
    { capture: true },
  );
  window.addEventListener("paste", (event) => {
    if (!event.defaultPrevented) open([...(event.clipboardData?.files ?? [])]);
  });
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape") cancel();
  });
}
