/**
 * From a height to its layer: on the processor, and as the shader does it. The two are twins, function for function;
 * a test runs the shader's search on the packed texture.
 */

/** Texels in a row of the texture of boundaries: every WebGL 2 takes this, and 1024 rows of it hold a million layers. */
export const ROW = 1024;

/** The layer whose range [z, z of the next) holds the height; the first below all, the last above. */
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

/** Rows that a texture of `count` boundaries takes. */
export const rowsFor = (count: number): number => Math.max(1, Math.ceil(count / ROW));

/** Writes the boundaries row by row into `into`, which holds whole rows; the rest keeps the last height. */
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
