/** The package's types as a page written in TypeScript uses them; compiled, never run. */
import { createSlicer, SlicerError } from "cusp-slicer";
import type { ErrorCode, ErrorDetails, Options, OrientationReport, Plan, PrintFile, Slicer, WarningCode } from "cusp-slicer";
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
  const place: ErrorDetails["infeasible"]["from_mm"] = 1;
  console.log(code, place);
});
// A code determines the type of its details.
element.addEventListener("cusp-error", ({ detail: error }) => {
  if (error.code === "infeasible") console.log((error.detail.least_tolerance ?? 0) * 2);
  // @ts-expect-error Only once the code is known.
  console.log(error.detail.from_mm);
});
// @ts-expect-error There is no such metric.
element.metric = "beauty";

const options: Options = { printer: "saturn-3-ultra", tolerance: 0.05 };
const slicer: Slicer = createSlicer();
const { signal } = new AbortController();
await slicer.load({ positions: new Float32Array(9), indices: [0, 1, 2] });
await createSlicer({ assets: "https://cdn.test/cusp/" }).load(await fetch("a.stl"));
await slicer.load(new URL("a.stl", location.href), { signal, onProgress: (stage, fraction) => console.log(stage, fraction) });
const plan: Plan = await slicer.plan(options, { signal });
const { name, type, blob, warnings }: PrintFile = await slicer.export();
for (const warning of warnings) {
  const code: WarningCode = warning.code;
  if (warning.code === "black-layers") console.log(code, warning.detail.layers + warning.detail.from_mm);
}
const picture: Blob = await element.thumbnail(200);
console.log(name.length, type.length, blob.size, picture.size);
// @ts-expect-error Workers are internal to the package.
createSlicer({ spawn: () => new Worker("worker.js") });
await slicer.exportStream(options).pipeTo(new WritableStream<Uint8Array>());
const { best }: OrientationReport = await slicer.orient(options, { alpha: 0.25, quality: "overhang" }, {
  signal,
  onCandidates: ({ directions, candidates }) => console.log(directions.length, candidates[0]?.excluded),
});
element.addEventListener("cusp-orientation", ({ detail }) => console.log(detail.rotation, best[0]?.metrics?.layers));
console.log(plan.profile.length, new SlicerError("crash", "", { system: "unreachable" }).detail.system);
