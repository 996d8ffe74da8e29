/** Welds the corners of a facet soup, and finds the facets that share an edge. */

/**
 * Half-edge `3 * facet + i` runs from corner `i` of the facet to the next one.
 */
export interface Topology {
  /** Distinct points, three numbers each, mm, in the file's pose. */
  readonly points: Float32Array;
  /** Index of the point at each corner. */
  readonly corner: Uint32Array;
  /** The half-edge in the opposite direction along the same edge; −1 if there is none. */
  readonly twin: Int32Array;
}

/** Facets between two yields. */
const BLOCK = 2048;

export const after = (halfEdge: number): number => (halfEdge % 3 === 2 ? halfEdge - 2 : halfEdge + 1);

const before = (halfEdge: number): number => (halfEdge % 3 === 0 ? halfEdge + 2 : halfEdge - 1);

/** Corners are the same point if their coordinates agree bit for bit (0 and −0 count as equal). */
function* weld(positions: Float32Array): Generator<number, Pick<Topology, "points" | "corner">> {
  const corners = positions.length / 3;
  const bits = new Uint32Array(positions.buffer, positions.byteOffset, positions.length);
  let slots = 1;
  while (slots < 2 * corners) slots *= 2;
  const mask = slots - 1;
  const first = new Int32Array(slots).fill(-1);
  const corner = new Uint32Array(corners);
  const points = new Float32Array(positions.length);
  const word = (at: number): number => (bits[at] === 0x80000000 ? 0 : (bits[at] ?? 0));
  let count = 0;
  for (let c = 0; c < corners; c++) {
    if (c % (3 * BLOCK) === 0) yield c / corners;
    const at = 3 * c;
    let hash = Math.imul(word(at), 0x9e3779b1) ^ Math.imul(word(at + 1), 0x85ebca77) ^ Math.imul(word(at + 2), 0xc2b2ae3d);
    hash = Math.imul(hash ^ (hash >>> 15), 0x2c1b3c6d);
    let slot = (hash ^ (hash >>> 13)) & mask;
    for (;;) {
      const known = first[slot] ?? -1;
      if (known < 0) {
        first[slot] = count;
        for (let axis = 0; axis < 3; axis++) points[3 * count + axis] = positions[at + axis] ?? 0;
        corner[c] = count++;
        break;
      }
      const p = 3 * known;
      if (points[p] === positions[at] && points[p + 1] === positions[at + 1] && points[p + 2] === positions[at + 2]) {
        corner[c] = known;
        break;
      }
      slot = (slot + 1) & mask;
    }
  }
  return { points: points.slice(0, 3 * count), corner };
}

/**
 * Finds the twin of each half-edge. On an edge of more than two facets, half-edges are paired as far as possible. Cost: the sum over all
 * edges of the smaller number of facets at either end.
 */
function* pair(corner: Uint32Array, points: number): Generator<number, Int32Array> {
  const start = new Uint32Array(points + 1);
  for (let c = 0; c < corner.length; c++) {
    if (c % (3 * BLOCK) === 0) yield c / (4 * corner.length);
    const point = corner[c] ?? 0;
    start[point + 1] = (start[point + 1] ?? 0) + 1;
  }
  for (let point = 0; point < points; point++) start[point + 1] = (start[point + 1] ?? 0) + (start[point] ?? 0);
  yield 0.25;
  const next = start.slice();
  const around = new Uint32Array(corner.length);
  for (let c = 0; c < corner.length; c++) {
    if (c % (3 * BLOCK) === 0) yield 0.25 + c / (4 * corner.length);
    const point = corner[c] ?? 0;
    const at = next[point] ?? 0;
    around[at] = c;
    next[point] = at + 1;
  }
  const degree = (point: number): number => (start[point + 1] ?? 0) - (start[point] ?? 0);
  const twin = new Int32Array(corner.length).fill(-1);
  for (let c = 0; c < corner.length; c++) {
    if (c % (3 * BLOCK) === 0) yield 0.5 + c / (2 * corner.length);
    if ((twin[c] ?? -1) >= 0) continue;
    const from = corner[c] ?? 0;
    const to = corner[after(c)] ?? 0;
    if (from === to) continue;
    // The twin leaves `to` and arrives at `from`: search the end that has fewer facets.
    const leaving = degree(to) <= degree(from);
    const at = leaving ? to : from;
    for (let i = start[at] ?? 0; i < (start[at + 1] ?? 0); i++) {
      const candidate = around[i] ?? 0;
      const other = leaving ? candidate : before(candidate);
      if ((twin[other] ?? -1) >= 0 || corner[other] !== to || corner[after(other)] !== from) continue;
      twin[c] = other;
      twin[other] = c;
      break;
    }
  }
  return twin;
}

/** Topology of `positions` (nine numbers per facet, mm). Yields its progress, 0 to 1. */
export function* topologyOf(positions: Float32Array): Generator<number, Topology> {
  const welding = weld(positions);
  let step = welding.next();
  for (; step.done !== true; step = welding.next()) yield step.value / 2;
  const { points, corner } = step.value;
  const pairing = pair(corner, points.length / 3);
  let pairs = pairing.next();
  for (; pairs.done !== true; pairs = pairing.next()) yield 0.5 + pairs.value / 2;
  return { points, corner, twin: pairs.value };
}
