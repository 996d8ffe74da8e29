/** Finds the places with the largest stair steps of a print. */
import { layerAt } from "./lookup.js";
import { extentOf, sizeOf, UPRIGHT, type Triple } from "./pose.js";

export interface Spot {
  /** The facet whose centre is the place. */
  readonly facet: number;
  /** In the file's pose, mm of the file. */
  readonly point: Triple;
  /** Thickness of the layer there, mm. */
  readonly thickness_mm: number;
}

/** Pose of the model, and the view of it. */
export interface Seen {
  /** Coefficients of the height above the plate, mm: factors of x, y and z of the file, and the offset. */
  readonly height: readonly [x: number, y: number, z: number, offset: number];
  /** Direction to the viewer in the file's pose, a unit vector. */
  readonly towards: Triple;
}

/** Facets between two yields. */
const BLOCK = 4096;

/** Cells of the grid along each axis. Facets in one cell are summed, so that no sliver decides. */
const CELLS = 24;

/** Minimum cosine of the angle between a facet's normal and the direction to the viewer. */
const FACING = 0.25;

/** Facets with a slope of a smaller sine are level and have no steps. */
const LEVEL = 0.05;

/** The width of a step counts up to this multiple of its height; wider ones are no easier to see. */
const WIDEST = 4;

/** Maximum number of places returned. */
const MOST = 4;

/**
 * Places where the widest steps (thickness over tangent of the slope) cover the largest area as seen by the viewer, best first; empty if
 * all facets that face the viewer are level or upright. Yields its progress, 0 to 1.
 *
 * Cost: linear in the facets, times the logarithm of the layers.
 */
export function* spotsOf(positions: Float32Array, z_mm: readonly number[], { height, towards }: Seen): Generator<number, Spot[]> {
  const facets = positions.length / 9;
  const extent = extentOf(positions, UPRIGHT, 1);
  const [x0, y0, z0] = extent.least;
  const perCell = CELLS / Math.max(1e-9, ...sizeOf(extent));
  const [hx, hy, hz, offset] = height;
  const [vx, vy, vz] = towards;
  const scale = Math.hypot(hx, hy, hz) || 1;
  const [ux, uy, uz] = [hx / scale, hy / scale, hz / scale];
  const sums = new Float64Array(CELLS ** 3);
  const best = new Float64Array(CELLS ** 3);
  const bestFacet = new Int32Array(CELLS ** 3).fill(-1);
  const cell = (away: number): number => Math.min(CELLS - 1, Math.floor(away * perCell));
  const value = (at: number): number => positions[at] ?? 0;
  const middle = (at: number): number => (value(at) + value(at + 3) + value(at + 6)) / 3;
  for (let facet = 0; facet < facets; facet++) {
    if (facet % BLOCK === 0) yield facet / facets;
    const at = 9 * facet;
    // Runs millions of times, so it does not destructure arrays.
    const x = value(at);
    const y = value(at + 1);
    const z = value(at + 2);
    const ax = value(at + 3) - x;
    const ay = value(at + 4) - y;
    const az = value(at + 5) - z;
    const bx = value(at + 6) - x;
    const by = value(at + 7) - y;
    const bz = value(at + 8) - z;
    const nx = ay * bz - az * by;
    const ny = az * bx - ax * bz;
    const nz = ax * by - ay * bx;
    const doubled = Math.sqrt(nx * nx + ny * ny + nz * nz);
    const facing = nx * vx + ny * vy + nz * vz;
    if (!(facing > FACING * doubled)) continue;
    const level = Math.abs(nx * ux + ny * uy + nz * uz) / doubled;
    const slope = Math.sqrt(Math.max(0, 1 - level * level));
    if (slope < LEVEL) continue;
    const cx = middle(at);
    const cy = middle(at + 1);
    const cz = middle(at + 2);
    const layer = layerAt(z_mm, hx * cx + hy * cy + hz * cz + offset);
    const thickness_mm = (z_mm[layer + 1] ?? 0) - (z_mm[layer] ?? 0);
    const score = facing * thickness_mm * Math.min(level / slope, WIDEST);
    if (!(score > 0)) continue;
    const place = cell(cx - x0) + CELLS * (cell(cy - y0) + CELLS * cell(cz - z0));
    sums[place] = (sums[place] ?? 0) + score;
    if (score > (best[place] ?? 0)) {
      best[place] = score;
      bestFacet[place] = facet;
    }
  }
  const found = [...bestFacet.keys()].filter((place) => (bestFacet[place] ?? -1) >= 0);
  found.sort((a, b) => (sums[b] ?? 0) - (sums[a] ?? 0));
  return found.slice(0, MOST).map((place) => {
    const facet = bestFacet[place] ?? 0;
    const at = 9 * facet;
    const point: Triple = [middle(at), middle(at + 1), middle(at + 2)];
    const layer = layerAt(z_mm, hx * point[0] + hy * point[1] + hz * point[2] + offset);
    return { facet, point, thickness_mm: (z_mm[layer + 1] ?? 0) - (z_mm[layer] ?? 0) };
  });
}
