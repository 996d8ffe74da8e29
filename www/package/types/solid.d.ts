/** `<cusp-slicer>` in the JSX of Solid. */
import type { JSX } from "solid-js";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerAttributes, CuspSlicerListeners } from "./src/element/markup.js";

type Explicit = { [Name in keyof CuspSlicerAttributes as `prop:${Name}` | `attr:${Name}`]?: CuspSlicerAttributes[Name] };

export type CuspSlicerProps = JSX.HTMLAttributes<CuspSlicer> & CuspSlicerAttributes & Explicit & CuspSlicerListeners<"on:">;

declare module "solid-js" {
  namespace JSX {
    interface IntrinsicElements {
      "cusp-slicer": CuspSlicerProps;
    }
  }
}
