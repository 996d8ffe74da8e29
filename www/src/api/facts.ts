/** Facts of the core that are needed before a worker has started: the build writes them from the core itself. */
import type { Facts, LayerRule } from "../../pkg/cusp_slicer.js";
import facts from "../../pkg/facts.json";
import type { Format, Metric, Options } from "./wire.js";

export const FACTS = facts as unknown as Facts;

/** The print formats, in the order of lists. */
export const FORMATS: readonly Format[] = FACTS.formats.map(({ name }) => name);

const ruleOf = (format: Format | ""): LayerRule | null => FACTS.formats.find(({ name }) => name === format)?.layer_rule ?? null;

/** Returns true if a format is for slicers of filament printers. */
export const isFilament = (format: Format | ""): boolean => ruleOf(format) !== null;

/** Products such as 0.4 · 75 are not whole. */
const ROUNDING = 1e-6;

/** The limits of layers and the first layer that apply for a slicer of filament printers and a nozzle if none are given; null for resin printers. */
export function nozzleLayers(format: Format | "", nozzle_mm: number): { layer_min_mm: number; layer_max_mm: number; first_layer_mm: number } | null {
  const rule = ruleOf(format);
  if (rule === null) return null;
  const down = (hundredths: number): number => Math.floor(hundredths + ROUNDING) / 100;
  const layer_min_mm = Math.max(Math.ceil(nozzle_mm * rule.least_percent - ROUNDING) / 100, rule.least_mm);
  const layer_max_mm = down(nozzle_mm * rule.most_percent);
  return { layer_min_mm, layer_max_mm, first_layer_mm: Math.min(Math.max(down(nozzle_mm * 50), layer_min_mm), layer_max_mm) };
}

/** The tolerance that applies if none is given; for volume, the core allows more if the model needs it. */
export function usualOf(metric: Metric, format: Format | "", nozzle_mm: number = FACTS.nozzle_mm): number {
  const usual = FACTS.metrics.find(({ name }) => name === metric)?.tolerance ?? Number.NaN;
  const layers = nozzleLayers(format, nozzle_mm);
  return layers === null ? usual : Number(((usual * layers.layer_min_mm) / FACTS.defaults.layer_min_mm).toFixed(6));
}

/**
 * Returns true if two sets of options cast the same rays. Planning for one after the other then takes milliseconds, and is not worth
 * interrupting.
 */
export function sameRays(a: Options, b: Options): boolean {
  return FACTS.ray_options.every((option) => JSON.stringify(a[option]) === JSON.stringify(b[option]));
}
