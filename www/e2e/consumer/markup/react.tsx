/** The element in JSX of React; compiled, never run. */
import { useRef } from "react";
import type { CuspSlicer } from "cusp-slicer/element-class";
import type { CuspSlicerProps } from "cusp-slicer/react";

const known: CuspSlicerProps = { printer: "saturn-3-ultra", tolerance: "0.05" };

export function Slicer() {
  const element = useRef<CuspSlicer>(null);
  return (
    <>
      <cusp-slicer
        {...known}
        ref={element}
        className="slicer"
        src="model.stl"
        layer-min="0.05"
        layerMax={0.15}
        metric="area"
        resins={[]}
        oncusp-plan={({ detail }) => console.log(detail.report.layers satisfies number)}
        // @ts-expect-error An event's details are its own.
        oncusp-export={({ detail }) => console.log(detail.report)}
        oncusp-error={({ detail }) => console.log(detail.code, element.current?.result?.report.layers)}
      />
      {/* @ts-expect-error There is no such metric. */}
      <cusp-slicer metric="beauty" />
      {/* @ts-expect-error A tolerance is a number. */}
      <cusp-slicer tolerance="fine" />
      {/* @ts-expect-error Only the element itself says what it is doing. */}
      <cusp-slicer state="done" />
    </>
  );
}
