/** `<cusp-slicer>` in Vue templates. */
import type { EmitFn, HTMLAttributes, PublicProps } from "vue";
import type { CuspSlicer } from "./src/element/index.js";
import type { CuspSlicerEvents } from "./src/element/events.js";
import type { CuspSlicerAttributes } from "./src/element/markup.js";

type Emits = { [Name in keyof CuspSlicerEvents]: (event: CuspSlicerEvents[Name]) => void };

declare module "vue" {
  interface GlobalComponents {
    "cusp-slicer": new () => CuspSlicer & {
      /** Exists only as a type, by which Vue checks templates. */
      $props: HTMLAttributes & CuspSlicerAttributes & PublicProps;
      $emit: EmitFn<Emits>;
    };
  }
}
