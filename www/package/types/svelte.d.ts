/** `<cusp-slicer>` in Svelte markup. */
import type { HTMLAttributes } from "svelte/elements";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerAttributes, CuspSlicerListeners } from "./src/element/markup.js";

declare module "svelte/elements" {
  interface SvelteHTMLElements {
    "cusp-slicer": HTMLAttributes<CuspSlicer> & CuspSlicerAttributes & CuspSlicerListeners<"on" | "on:">;
  }
}
