/** `<cusp-slicer>` in the JSX of Preact. */
import type { ClassAttributes, HTMLAttributes } from "preact";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerAttributes, CuspSlicerListeners } from "./src/element/markup.js";

export type CuspSlicerProps = HTMLAttributes<CuspSlicer> & ClassAttributes<CuspSlicer> & CuspSlicerAttributes & CuspSlicerListeners<"on">;

declare module "preact" {
  namespace JSX {
    interface IntrinsicElements {
      "cusp-slicer": CuspSlicerProps;
    }
  }
}
