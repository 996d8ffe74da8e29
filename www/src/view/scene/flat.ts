/** Flat face of a model around a facet: the meaning of a click on that facet. */
import type { Topology } from "./topology.js";
import type { Triple } from "./pose.js";

/** Maximum angle between the normals of a face's facets and that of the clicked facet, degrees. */
export const FLAT_WITHIN_DEG = 1;

export interface FlatFace {
  readonly facets: readonly number[];
  /** Area-weighted mean of the facets' normals, a unit vector in the file's pose. */
  readonly normal: Triple;
  readonly area_mm2: number;
}

/** Normal of a facet; its length is twice the area. */
export function doubleArea(positions: Float32Array, facet: number): Triple {
  const at = 9 * facet;
  const p = (i: number): number => positions[at + i] ?? 0;
  const [ux, uy, uz] = [p(3) - p(0), p(4) - p(1), p(5) - p(2)];
  const [vx, vy, vz] = [p(6) - p(0), p(7) - p(1), p(8) - p(2)];
  return [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
}

/**
 * Facets connected to `facet` with normals within `within_deg` of its own. Facets without area always belong to the face. Null if the facet
 * itself has no area.
 */
export function flatFace(
  positions: Float32Array,
  { twin }: Pick<Topology, "twin">,
  facet: number,
  within_deg = FLAT_WITHIN_DEG,
): FlatFace | null {
  const seed = doubleArea(positions, facet);
  const seedLength = Math.hypot(...seed);
  if (!(seedLength > 0)) return null;
  const least = Math.cos((within_deg * Math.PI) / 180);
  const seen = new Set([facet]);
  const facets = [facet];
  let [x, y, z, doubled] = [0, 0, 0, 0];
  for (let i = 0; i < facets.length; i++) {
    const here = facets[i] ?? 0;
    const [nx, ny, nz] = doubleArea(positions, here);
    x += nx;
    y += ny;
    z += nz;
    doubled += Math.hypot(nx, ny, nz);
    for (let edge = 3 * here; edge < 3 * here + 3; edge++) {
      const other = twin[edge] ?? -1;
      const next = Math.floor(other / 3);
      if (other < 0 || seen.has(next)) continue;
      const normal = doubleArea(positions, next);
      const length = Math.hypot(...normal);
      const along = normal[0] * seed[0] + normal[1] * seed[1] + normal[2] * seed[2];
      if (length > 0 && along < least * length * seedLength) continue;
      seen.add(next);
      facets.push(next);
    }
  }
  const length = Math.hypot(x, y, z);
  return { facets, normal: [x / length, y / length, z / length], area_mm2: doubled / 2 };
}
