/** `<cusp-slicer>` in the JSX of React 19. */
import type { ClassAttributes, HTMLAttributes } from "react";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerAttributes, CuspSlicerListeners } from "./src/element/markup.js";

export type CuspSlicerProps = HTMLAttributes<CuspSlicer> & ClassAttributes<CuspSlicer> & CuspSlicerAttributes & CuspSlicerListeners<"on">;

declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      "cusp-slicer": CuspSlicerProps;
    }
  }
}
