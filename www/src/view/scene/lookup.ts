/**
 * Finds the layer at a height, on the CPU and in the shader. The two searches match step by step; a test runs the search
 * on the packed texture.
 */

/** Texels per row of the texture of boundaries. Every WebGL 2 supports this width; 1024 rows hold a million layers. */
export const ROW = 1024;

/** The layer whose range [bottom, top) contains the height; the first layer below all ranges, the last above. */
export function layerAt(boundaries_mm: ArrayLike<number>, z_mm: number): number {
  let low = 0;
  let high = boundaries_mm.length - 2;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((boundaries_mm[middle] ?? 0) <= z_mm) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Rows of a texture that holds `count` boundaries. */
export const rowsFor = (count: number): number => Math.max(1, Math.ceil(count / ROW));

/** Writes the boundaries into `into`, which holds whole rows; the last height fills the rest. */
export function packBoundaries(boundaries_mm: ArrayLike<number>, into: Float32Array): void {
  const last = boundaries_mm[boundaries_mm.length - 1] ?? 0;
  for (let i = 0; i < into.length; i++) into[i] = boundaries_mm[i] ?? last;
}

/** `layerAt` for a shader that has `uniform sampler2D boundaries` and `uniform int layers`. */
export const LAYER_AT_GLSL = /* glsl */ `
float boundary(int i) {
  return texelFetch(boundaries, ivec2(i % ${ROW}, i / ${ROW}), 0).r;
}

int layerAt(float z) {
  int low = 0;
  int high = layers - 1;
  while (low < high) {
    int middle = (low + high + 1) >> 1;
    if (boundary(middle) <= z) low = middle;
    else high = middle - 1;
  }
  return low;
}
`;
