/** Lets a model be dropped or pasted anywhere on the page, and Escape cancel wherever the focus is. */
import type { CuspSlicer } from "../element/index.js";

export function openAnywhere(slicer: CuspSlicer, dragging: (is: boolean) => void): void {
  const open = (files: readonly File[]): void => {
    if (files.length === 0) return;
    slicer.willOrphan();
    // The element shows any error.
    slicer.load(files).catch(() => undefined);
  };

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
