/** What a brush does to the weights of facets. */
import type { Topology } from "../scene/topology.js";

/**
 * What the weights move towards. `more`: 1. `less`: 0. `erase`: the weight of unpainted facets. `soften`: the mean of the
 * adjacent facets.
 */
export type BrushMode = "more" | "less" | "erase" | "soften";

export interface Brush {
  readonly mode: BrushMode;
  /** Diameter of the sphere within which it paints, mm of the scaled model. */
  readonly size_mm: number;
  /** How far the weight goes towards what the brush paints in one stroke, 0 to 1. */
  readonly strength: number;
  /** Takes the smooth region under the pointer instead of a sphere. */
  readonly fills: boolean;
  /** The bend at which a smooth region ends, degrees. */
  readonly crease_deg: number;
  /** Paints the other side as well, mirrored at the middle of the model's extent in x in its file. */
  readonly mirrors: boolean;
  /** Weight of unpainted facets, 0 to 1. */
  readonly base: number;
}

/** By default all facets have full weight, and the brush lowers it. */
export const BRUSH: Brush = {
  mode: "less",
  size_mm: 10,
  strength: 1,
  fills: false,
  crease_deg: 30,
  mirrors: false,
  base: 1,
};

/** Fraction of the radius that is painted in full; beyond it the brush fades. */
const CORE = 0.5;

/** How strongly a brush of this radius paints at a distance: 1 around the middle, 0 from the rim on, smooth in between. */
export function falloff(distance_mm: number, radius_mm: number): number {
  const place = Math.min(1, Math.max(0, (distance_mm / radius_mm - CORE) / (1 - CORE)));
  return 1 - place * place * (3 - 2 * place);
}

/** The weight that a brush paints towards; null if it depends on the adjacent facets. */
export function targetOf({ mode, base }: Brush): number | null {
  return mode === "more" ? 1 : mode === "less" ? 0 : mode === "erase" ? base : null;
}

/** Mean weight of the facets that share an edge with this one; its own weight if there are none. */
export function meanBeside(weights: Float32Array, { twin }: Pick<Topology, "twin">, facet: number): number {
  let [sum, count] = [0, 0];
  for (let edge = 3 * facet; edge < 3 * facet + 3; edge++) {
    const other = twin[edge] ?? -1;
    if (other < 0) continue;
    sum += weights[Math.floor(other / 3)] ?? 0;
    count++;
  }
  return count === 0 ? (weights[facet] ?? 0) : sum / count;
}

/** Changes the weight of unpainted facets: those that have exactly the old one get the new one. */
export function rebased(weights: Float32Array, before: number, base: number): Float32Array {
  const old = Math.fround(before);
  return weights.map((weight) => (weight === old ? base : weight));
}
