/** Facets covered by a brush or a fill: those connected to the facet where it is applied. */
import { doubleArea } from "../scene/flat.js";
import type { Triple } from "../scene/pose.js";
import type { Topology } from "../scene/topology.js";

/** The surface of a model in the file's pose. */
export interface Surface {
  /** Nine numbers per facet, mm. */
  readonly positions: Float32Array;
  readonly topology: Pick<Topology, "twin">;
  /** Unit normals, three numbers per facet; zeros for facets without area. */
  readonly normals: Float32Array;
}

export function normalsOf(positions: Float32Array): Float32Array {
  const normals = new Float32Array(positions.length / 3);
  for (let facet = 0; 9 * facet < positions.length; facet++) {
    const [x, y, z] = doubleArea(positions, facet);
    const length = Math.hypot(x, y, z);
    if (length > 0) normals.set([x / length, y / length, z / length], 3 * facet);
  }
  return normals;
}

/**
 * Cosine of the angle between the normals of two facets; 1 if either has no area. Runs thousands of times per pointer move, so it does not
 * destructure arrays.
 */
function cosineOf(normals: Float32Array, a: number, b: number): number {
  const x = normals[3 * a] ?? 0;
  const y = normals[3 * a + 1] ?? 0;
  const z = normals[3 * a + 2] ?? 0;
  const u = normals[3 * b] ?? 0;
  const v = normals[3 * b + 1] ?? 0;
  const w = normals[3 * b + 2] ?? 0;
  if ((x === 0 && y === 0 && z === 0) || (u === 0 && v === 0 && w === 0)) return 1;
  return x * u + y * v + z * w;
}

/**
 * Facets reached from `seed` across shared edges that `takes` accepts, the seed first. A facet refused across one edge may still be reached
 * across another.
 */
function grown(twin: Int32Array, seed: number, takes: (from: number, to: number) => boolean): number[] {
  const seen = new Set([seed]);
  const facets = [seed];
  for (let i = 0; i < facets.length; i++) {
    const here = facets[i] ?? 0;
    for (let edge = 3 * here; edge < 3 * here + 3; edge++) {
      const other = twin[edge] ?? -1;
      const next = Math.floor(other / 3);
      if (other < 0 || seen.has(next) || !takes(here, next)) continue;
      seen.add(next);
      facets.push(next);
    }
  }
  return facets;
}

/** Smooth region of a facet: crosses no edge at which the surface bends by more than `crease_deg`. Facets without area count as smooth. */
export function smoothRegion({ topology, normals }: Surface, seed: number, crease_deg: number): number[] {
  // Normals are single precision, so the cosine between coplanar facets may be this far below 1.
  const least = Math.cos((crease_deg * Math.PI) / 180) - 1e-6;
  return grown(topology.twin, seed, (from, to) => cosineOf(normals, from, to) >= least);
}

export interface Touched {
  readonly facets: readonly number[];
  /** Distance of each facet from the path, mm. */
  readonly distances_mm: readonly number[];
}

/**
 * Facets connected to `seed` that lie within `radius_mm` of any point of a path and face the same half-space as the seed. The seed is the
 * facet at the end of the path, and is always included.
 */
export function brushRegion(
  { positions, topology, normals }: Surface,
  seed: number,
  path: readonly Triple[],
  radius_mm: number,
): Touched {
  const distances = new Map<number, number>([[seed, distanceTo(positions, seed, path)]]);
  const facets = grown(topology.twin, seed, (_, facet) => {
    if (cosineOf(normals, seed, facet) <= 0) return false;
    const distance = distanceTo(positions, facet, path);
    if (distance > radius_mm) return false;
    distances.set(facet, distance);
    return true;
  });
  return { facets, distances_mm: facets.map((facet) => distances.get(facet) ?? 0) };
}

function distanceTo(positions: Float32Array, facet: number, path: readonly Triple[]): number {
  let least = Infinity;
  for (const point of path) least = Math.min(least, distanceToFacet(positions, facet, point));
  return least;
}

/**
 * Distance of a point from a facet, mm (Ericson, Real-Time Collision Detection, 2005, section 5.1.5). For a facet without area, the
 * distance from its nearest corner or edge.
 */
export function distanceToFacet(positions: Float32Array, facet: number, [x, y, z]: Triple): number {
  const at = 9 * facet;
  const ax = positions[at] ?? 0;
  const ay = positions[at + 1] ?? 0;
  const az = positions[at + 2] ?? 0;
  const bx = (positions[at + 3] ?? 0) - ax;
  const by = (positions[at + 4] ?? 0) - ay;
  const bz = (positions[at + 5] ?? 0) - az;
  const cx = (positions[at + 6] ?? 0) - ax;
  const cy = (positions[at + 7] ?? 0) - ay;
  const cz = (positions[at + 8] ?? 0) - az;
  const px = x - ax;
  const py = y - ay;
  const pz = z - az;
  /** Distance from the point a + v·b + w·c. */
  const from = (v: number, w: number): number => {
    const x = px - v * bx - w * cx;
    const y = py - v * by - w * cy;
    const z = pz - v * bz - w * cz;
    // Many times faster than Math.hypot.
    return Math.sqrt(x * x + y * y + z * z);
  };
  const d1 = bx * px + by * py + bz * pz;
  const d2 = cx * px + cy * py + cz * pz;
  if (d1 <= 0 && d2 <= 0) return from(0, 0);
  const bb = bx * bx + by * by + bz * bz;
  const bc = bx * cx + by * cy + bz * cz;
  const cc = cx * cx + cy * cy + cz * cz;
  const d3 = d1 - bb;
  const d4 = d2 - bc;
  if (d3 >= 0 && d4 <= d3) return from(1, 0);
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(d1 / (d1 - d3), 0);
  const d5 = d1 - bc;
  const d6 = d2 - cc;
  if (d6 >= 0 && d5 <= d6) return from(0, 1);
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(0, d2 / (d2 - d6));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const w = (d4 - d3) / (d4 - d3 + (d5 - d6));
    return from(1 - w, w);
  }
  const sum = va + vb + vc;
  return from(vb / sum, vc / sum);
}
