/** The element in Vue templates, as Vue's compiler looks it up; compiled, never run. */
import type { Plan } from "cusp-slicer";
import "cusp-slicer/vue";
import type { GlobalComponents } from "vue";

declare const plan: Plan;
declare const element: InstanceType<GlobalComponents["cusp-slicer"]>;
type Props = (typeof element)["$props"];

export const props: Props = { class: "slicer", printer: "saturn-3-ultra", "layer-min": "0.05", layerMax: 0.15, resins: [] };
element.$emit("cusp-plan", new CustomEvent("cusp-plan", { detail: plan }));
// @ts-expect-error There is no such metric.
export const wrong: Props = { metric: "beauty" };
// @ts-expect-error There is no such event.
element.$emit("cusp-plans", new CustomEvent("cusp-plans"));
