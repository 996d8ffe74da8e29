/**
 * Finds the layer at a height, on the CPU and in the shader. The shader divides the height into many equal cells with a known lowest layer,
 * and searches from there: in software WebGL, one texel lookup takes about as long as the rest of a pixel. A test runs the shader's search
 * on the packed texture.
 */

/** Texels per row of the texture of boundaries. Every WebGL 2 supports this width; 1024 rows hold a third of a million layers. */
export const ROW = 1024;

/** Cells per layer: few contain more than one boundary, however uneven the layers are. */
export const CELLS = 2;

/** Upper bound of the single-precision rounding error of a height, in cells. */
const SLACK_CELLS = 0.1;

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

/** Number of texture rows for `count` boundaries and the cells. */
export const rowsFor = (count: number): number => Math.max(1, Math.ceil(((1 + CELLS) * count) / ROW));

/**
 * Writes the boundaries to `into`, which has whole rows, followed by the lowest layer of each cell.
 *
 * @returns cells per millimetre
 */
export function packBoundaries(boundaries_mm: ArrayLike<number>, into: Float32Array): number {
  const count = boundaries_mm.length;
  const last_mm = boundaries_mm[count - 1] ?? 0;
  into.set(Array.from(boundaries_mm));
  const cells = CELLS * Math.max(0, count - 1);
  const perMm = last_mm > 0 ? cells / last_mm : 0;
  let layer = 0;
  for (let cell = 0; cell < cells; cell++) {
    while (layer < count - 2 && (boundaries_mm[layer + 1] ?? 0) * perMm <= cell - SLACK_CELLS) layer++;
    into[count + cell] = layer;
  }
  return perMm;
}

/** `layerAt` for a shader that has `uniform sampler2D boundaries`, `uniform int layers` and `uniform float cellsPerMm`. */
export const LAYER_AT_GLSL = /* glsl */ `
float boundary(int i) {
  return texelFetch(boundaries, ivec2(i % ${ROW}, i / ${ROW}), 0).r;
}

int layerAt(float z) {
  int cell = clamp(int(z * cellsPerMm), 0, ${CELLS} * layers - 1);
  int layer = int(boundary(layers + 1 + cell));
  while (layer < layers - 1 && boundary(layer + 1) <= z) layer++;
  return layer;
}
`;
