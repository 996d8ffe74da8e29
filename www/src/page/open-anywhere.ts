/** Lets files be dropped or pasted anywhere on the page, and Escape cancel wherever the focus is. */
import { takeDrop, type DropHost } from "../element/dropped.js";

export interface Anywhere extends DropHost {
  dragging(is: boolean): void;
  cancel(): void;
}

export function openAnywhere(anywhere: Anywhere): void {
  const { dragging, open, cancel } = anywhere;
  // Captured before the element sees them, so that it need not tell its own drops from the page's. A drop beside the
  // element must not make the browser leave the page.
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
    // Moving from one element to another does not leave the page.
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
