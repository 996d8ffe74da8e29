/** What the heat map shows of each facet. */

/** What was painted, what stands out, or how much a facet counts by both. */
export type Heat = "paint" | "saliency" | "product";

export interface HeatSource {
  readonly heat: Heat;
  /** 0 to 1 a facet; null: all 1. */
  readonly weights: Float32Array | null;
  readonly saliency: Float32Array | null;
  /** What a facet counts for at least where something is weighted. */
  readonly least: number;
}

/** 0 to 1. */
export function heatOf({ heat, weights, saliency, least }: HeatSource, facet: number): number {
  const paint = weights?.[facet] ?? 1;
  const standing = saliency?.[facet] ?? 1;
  if (heat === "paint") return paint;
  if (heat === "saliency") return standing;
  return Math.max(least, paint * standing);
}

/** Texels in a row of the texture of facets: every WebGL 2 takes this. */
export const HEAT_ROW = 2048;

/** Writes the heat of some facets, 0 to 255 each; gives the least and greatest of their numbers, or `null` for none. */
export function packHeat(
  source: HeatSource,
  facets: Iterable<number>,
  into: Uint8Array,
): readonly [first: number, last: number] | null {
  let [first, last] = [Infinity, -1];
  for (const facet of facets) {
    into[facet] = Math.round(255 * heatOf(source, facet));
    first = Math.min(first, facet);
    last = Math.max(last, facet);
  }
  return last < 0 ? null : [first, last];
}
