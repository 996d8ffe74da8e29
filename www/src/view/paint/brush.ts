/** Effect of a brush on the weights of facets. */
import type { Topology } from "../scene/topology.js";

/** Target of the weights. `more`: 1. `less`: 0. `erase`: the weight of unpainted facets. `soften`: the mean of the adjacent facets. */
export type BrushMode = "more" | "less" | "erase" | "soften";

export interface Brush {
  readonly mode: BrushMode;
  /** Diameter of the brush's sphere, mm of the scaled model. */
  readonly size_mm: number;
  /** Fraction of the way to the target in one stroke, 0 to 1. */
  readonly strength: number;
  /** If true, fills the smooth region under the pointer instead of a sphere. */
  readonly fills: boolean;
  /** Bend at which a smooth region ends, degrees. */
  readonly crease_deg: number;
  /** If true, also paints the other side, mirrored at the middle of the model's x extent in its file. */
  readonly mirrors: boolean;
  /** Weight of unpainted facets, 0 to 1. */
  readonly base: number;
}

/** By default, all facets have full weight, which the brush lowers. */
export const BRUSH: Brush = {
  mode: "less",
  size_mm: 10,
  strength: 1,
  fills: false,
  crease_deg: 30,
  mirrors: false,
  base: 1,
};

/** Fraction of the radius painted in full; beyond it the brush fades. */
const CORE = 0.5;

/** Strength of a brush of this radius at a distance: 1 around the centre, 0 from the rim on, smooth in between. */
export function falloff(distance_mm: number, radius_mm: number): number {
  const place = Math.min(1, Math.max(0, (distance_mm / radius_mm - CORE) / (1 - CORE)));
  return 1 - place * place * (3 - 2 * place);
}

/** Target weight of a brush; null if it depends on the adjacent facets. */
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

/** Changes the weight of unpainted facets, which have exactly the old one. */
export function rebased(weights: Float32Array, before: number, base: number): Float32Array {
  const old = Math.fround(before);
  return weights.map((weight) => (weight === old ? base : weight));
}
