/** The element in JSX of Solid; compiled, never run. */
import { createSignal } from "solid-js";
import type { CuspSlicerProps } from "cusp-slicer/solid";

const known: CuspSlicerProps = { printer: "saturn-3-ultra", tolerance: "0.05" };

export function Slicer() {
  const [layers, setLayers] = createSignal(0);
  return (
    <>
      <cusp-slicer
        {...known}
        ref={(element) => console.log(element.result)}
        class="slicer"
        layer-min="0.05"
        attr:layer-max="0.15"
        metric="area"
        prop:resins={[]}
        on:cusp-plan={({ detail }) => setLayers(detail.report.layers)}
        // @ts-expect-error An event's details are its own.
        on:cusp-export={({ detail }) => console.log(detail.report)}
      />
      {layers()}
      {/* @ts-expect-error There is no such metric. */}
      <cusp-slicer metric="beauty" />
    </>
  );
}
