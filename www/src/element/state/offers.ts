/** Offers to fix a problem by a change of settings. */
import type { UniformLayers } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import type { Settings } from "./settings.js";

/** A change of settings that may fix a problem, offered as a button. */
export interface Offer {
  label: string;
  change: Partial<Settings>;
}

/** Offers that change no fixed setting. */
export function allowed(offers: readonly Offer[], fixed: ReadonlySet<keyof Settings>): Offer[] {
  return offers.filter(({ change }) => (Object.keys(change) as (keyof Settings)[]).every((key) => !fixed.has(key)));
}

/** Settings of uniform layers, without the rounding error of a sum of bins. */
export const uniformOf = ({ layer_mm }: UniformLayers): Partial<Settings> => ({ planner: "uniform", uniform: String(Number(layer_mm.toFixed(6))) });

export function bestUniform(best: UniformLayers, { texts, format }: Language): Offer {
  return { label: texts.offers.bestUniform({ thickness: format.fine(best.layer_mm), layers: best.layers }), change: uniformOf(best) };
}
