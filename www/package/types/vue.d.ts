/** `<cusp-slicer>` in templates of Vue. */
import type { EmitFn, HTMLAttributes, PublicProps } from "vue";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerEvents } from "./src/element/events.js";
import type { CuspSlicerAttributes } from "./src/element/markup.js";

type Emits = { [Name in keyof CuspSlicerEvents]: (event: CuspSlicerEvents[Name]) => void };

declare module "vue" {
  interface GlobalComponents {
    "cusp-slicer": new () => CuspSlicer & {
      /** Not there when the page runs: what templates are checked by. */
      $props: HTMLAttributes & CuspSlicerAttributes & PublicProps;
      $emit: EmitFn<Emits>;
    };
  }
}
