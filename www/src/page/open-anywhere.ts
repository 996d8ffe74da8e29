/** A model may be dropped or pasted anywhere on the page, and Escape or undo work wherever the focus is. */
import type { CuspSlicer } from "../element/index.js";

export function openAnywhere(slicer: CuspSlicer, dragging: (is: boolean) => void): void {
  const open = (files: readonly File[]): void => {
    if (files.length === 0) return;
    slicer.willOrphan();
    // What goes wrong is shown by the element.
    slicer.load(files).catch(() => undefined);
  };

  // Before the element sees them, so that it need not tell its own from the page's; a miss must not make the browser leave.
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
    // Leaving an element for one inside it is no leaving of the page.
    if (event.relatedTarget === null) dragging(false);
  });
  window.addEventListener(
    "drop",
    (event) => {
      event.preventDefault();
      event.stopPropagation();
      dragging(false);
      open([...(event.dataTransfer?.files ?? [])]);
    },
    { capture: true },
  );
  window.addEventListener("paste", (event) => {
    if (!event.defaultPrevented) open([...(event.clipboardData?.files ?? [])]);
  });
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape") slicer.cancel();
  });
}
