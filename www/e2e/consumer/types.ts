/** The package's types as a page written in TypeScript uses them; compiled, never run. */
import { createSlicer, ERROR_CODES, SlicerError, type ErrorCode, type Options, type Orientation, type Plan, type Slicer } from "cusp-slicer";
import "cusp-slicer/element";
import { CuspSlicer } from "cusp-slicer/element-class";

class ShopSlicer extends CuspSlicer {}
customElements.define("shop-slicer", ShopSlicer);

const element = document.createElement("cusp-slicer");
element.metric = "area";
element.tolerance = 0.1;
element.addEventListener("cusp-plan", ({ detail }) => {
  const layers: number = detail.report.layers;
  console.log(layers, detail.schema);
});
element.addEventListener("cusp-error", ({ detail }) => {
  const code: ErrorCode = detail.code;
  console.log(ERROR_CODES[code]);
});
// @ts-expect-error There is no such metric.
element.metric = "beauty";

const options: Options = { printer: "saturn-3-ultra", tolerance: 0.05 };
const slicer: Slicer = createSlicer();
const { signal } = new AbortController();
await slicer.load(new URL("a.stl", location.href), { signal, onProgress: (stage, fraction) => console.log(stage, fraction) });
const plan: Plan = await slicer.plan(options, { signal });
await slicer.exportStream(options).pipeTo(new WritableStream<Uint8Array>());
const { best }: Orientation = await slicer.orient(options, { alpha: 0.25, quality: "overhang" }, {
  signal,
  onCandidates: ({ directions, candidates }) => console.log(directions.length, candidates[0]?.excluded),
});
element.addEventListener("cusp-direction", ({ detail }) => console.log(detail.rotation, best[0]?.figures?.layers));
console.log(plan.profile.length, new SlicerError("crash", "").detail);
