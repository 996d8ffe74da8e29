/** The element in Svelte markup, as Svelte's compiler looks it up; compiled, never run. */
import "cusp-slicer/svelte";
import type { SvelteHTMLElements } from "svelte/elements";

type Props = SvelteHTMLElements["cusp-slicer"];

export const props: Props = {
  class: "slicer",
  printer: "saturn-3-ultra",
  "layer-min": "0.05",
  layerMax: 0.15,
  "oncusp-plan": ({ detail }) => console.log(detail.report.layers satisfies number),
  "on:cusp-error": ({ detail }) => console.log(detail.code),
};
// @ts-expect-error There is no such metric.
export const wrong: Props = { metric: "beauty" };
// @ts-expect-error There is no such event.
export const unknown: Props = { "oncusp-plans": () => undefined };
