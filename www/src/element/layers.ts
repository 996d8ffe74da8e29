/** Finding one's way among the layers of a plan. */

/** The layer whose range holds the height `z`. */
export function layerAt(boundaries_mm: readonly number[], z: number): number {
  let low = 0;
  let high = boundaries_mm.length - 2;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((boundaries_mm[middle] ?? 0) <= z) low = middle;
    else high = middle - 1;
  }
  return Math.max(0, low);
}
