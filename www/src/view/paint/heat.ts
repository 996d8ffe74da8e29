/** Values of the heat map for each facet. */

/** Value shown: the painted weight, the saliency, or the product of the two. */
export type Heat = "paint" | "saliency" | "product";

export interface HeatSource {
  readonly heat: Heat;
  /** Weight of each facet, 0 to 1; null: all 1. */
  readonly weights: Float32Array | null;
  readonly saliency: Float32Array | null;
  /** Minimum of the product. */
  readonly least: number;
}

/** Heat of a facet, 0 to 1. */
export function heatOf({ heat, weights, saliency, least }: HeatSource, facet: number): number {
  const paint = weights?.[facet] ?? 1;
  const standing = saliency?.[facet] ?? 1;
  if (heat === "paint") return paint;
  if (heat === "saliency") return standing;
  return Math.max(least, paint * standing);
}

/** Texels per row of the heat texture, four facets per texel. Every WebGL 2 supports this width. */
export const HEAT_ROW = 2048;

/** Facets per row of that texture. */
export const HEAT_ROW_FACETS = 4 * HEAT_ROW;

/** Writes the heat of these facets, 0 to 255 each; returns the affected rows. */
export function packHeat(source: HeatSource, facets: Iterable<number>, into: Uint8Array): ReadonlySet<number> {
  const rows = new Set<number>();
  for (const facet of facets) {
    into[facet] = Math.round(255 * heatOf(source, facet));
    rows.add(Math.floor(facet / HEAT_ROW_FACETS));
  }
  return rows;
}

/** The heat of a facet for a shader that has `uniform sampler2D heat`. */
export const HEAT_GLSL = /* glsl */ `
float heatAt(int facet) {
  int texel = facet >> 2;
  return texelFetch(heat, ivec2(texel % ${HEAT_ROW}, texel / ${HEAT_ROW}), 0)[facet & 3];
}
`;
