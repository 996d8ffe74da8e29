/** Binary STL. */

const HEADER_BYTES = 80;
const FACET_BYTES = 50;

/** @param positions nine numbers per facet, in mm */
export function stlOf(positions: Float32Array): Uint8Array<ArrayBuffer> {
  const facets = Math.floor(positions.length / 9);
  const bytes = new Uint8Array(HEADER_BYTES + 4 + FACET_BYTES * facets);
  const view = new DataView(bytes.buffer);
  view.setUint32(HEADER_BYTES, facets, true);
  for (let facet = 0; facet < facets; facet++) {
    // Normals stay zero: readers compute them from the corners.
    const at = HEADER_BYTES + 4 + FACET_BYTES * facet + 12;
    for (let i = 0; i < 9; i++) view.setFloat32(at + 4 * i, positions[9 * facet + i] ?? 0, true);
  }
  return bytes;
}
