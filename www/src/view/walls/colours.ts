/** Colours of wall thickness on the model: textures of the samples, and the shader that looks them up. */
import { DataTexture, FloatType, NearestFilter, RedFormat, RGIntegerFormat, UnsignedIntType, type IUniform } from "three";
import type { WallScale } from "./scale.js";
import type { Walls } from "./thickness.js";

/** Texels per row of both textures. Every WebGL 2 supports this width. */
const ROW = 2048;

/** Width of the stripes over thin walls, pixels. */
const STRIPE_PX = 5;

/** Stands for an unknown thickness, mm: beyond every scale. A texture of infinities could not be interpolated. */
const UNKNOWN_MM = 1e9;

function filled(texture: DataTexture): DataTexture {
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

const rowsOf = (texels: number): number => Math.max(1, Math.ceil(texels / ROW));

function gridsTexture(grids: Uint32Array): DataTexture {
  const rows = rowsOf(grids.length / 2);
  const data = new Uint32Array(2 * ROW * rows);
  data.set(grids);
  return filled(new DataTexture(data, ROW, rows, RGIntegerFormat, UnsignedIntType));
}

function thicknessTexture(thickness_mm: Float32Array): DataTexture {
  const rows = rowsOf(thickness_mm.length);
  const data = new Float32Array(ROW * rows);
  for (const [i, mm] of thickness_mm.entries()) data[i] = Math.min(mm, UNKNOWN_MM);
  return filled(new DataTexture(data, ROW, rows, RedFormat, FloatType));
}

/** The uniforms that `WALLS_GLSL` declares. */
export class WallColours {
  readonly uniforms: Readonly<Record<string, IUniform>>;
  #grids = gridsTexture(new Uint32Array(0));
  #thickness = thicknessTexture(new Float32Array(0));

  constructor() {
    this.uniforms = {
      wallGrids: { value: this.#grids },
      wallThickness: { value: this.#thickness },
      wallScale: { value: 0 },
      wallLeast: { value: 0 },
    };
  }

  set(walls: Walls | null): void {
    this.dispose();
    this.#grids = gridsTexture(walls?.grids ?? new Uint32Array(0));
    this.#thickness = thicknessTexture(walls?.thickness_mm ?? new Float32Array(0));
    this.#put("wallGrids", this.#grids);
    this.#put("wallThickness", this.#thickness);
  }

  /** @param scale factor from the file's lengths to those of the model */
  setScale({ least_mm, full_mm }: WallScale, scale: number): void {
    this.#put("wallScale", scale / full_mm);
    this.#put("wallLeast", least_mm / full_mm);
  }

  dispose(): void {
    this.#grids.dispose();
    this.#thickness.dispose();
  }

  #put(name: string, value: unknown): void {
    const uniform = this.uniforms[name];
    if (uniform !== undefined) uniform.value = value;
  }
}

/**
 * Thickness at a place of a facet as a fraction of the scale's end, interpolated between the samples of the facet, and its colour. For a
 * shader with `ofHeat`, where 1 is the thinnest.
 */
export const WALLS_GLSL = /* glsl */ `
uniform highp usampler2D wallGrids;
uniform sampler2D wallThickness;
uniform float wallScale;
uniform float wallLeast;

float wallSample(int cell) {
  return texelFetch(wallThickness, ivec2(cell % ${ROW}, cell / ${ROW}), 0).r;
}

/** @param corners the weights of the facet's corners */
float wallAt(int facet, vec3 corners) {
  uvec2 grid = texelFetch(wallGrids, ivec2(facet % ${ROW}, facet / ${ROW}), 0).rg;
  int first = int(grid.x);
  int columns = int(grid.y & 4095u);
  int rows = int((grid.y >> 12u) & 4095u);
  int apex = int(grid.y >> 24u);
  float up = corners[apex];
  float to = corners[(apex + 2) % 3];
  float across = to / max(corners[(apex + 1) % 3] + to, 1e-6);
  vec2 place = clamp(vec2(across, up) * vec2(columns, rows) - 0.5, vec2(0.0), vec2(columns - 1, rows - 1));
  ivec2 low = ivec2(place);
  ivec2 high = min(low + 1, ivec2(columns - 1, rows - 1));
  vec2 part = place - vec2(low);
  int row = first + low.y * columns;
  int next = first + high.y * columns;
  float below = mix(wallSample(row + low.x), wallSample(row + high.x), part.x);
  float above = mix(wallSample(next + low.x), wallSample(next + high.x), part.x);
  return wallScale * mix(below, above, part.y);
}

/** Red with white stripes where it is too thin: no other colour of the scale, and a pattern for those who see none. */
vec3 ofWall(float thickness) {
  if (thickness >= wallLeast) return ofHeat(1.0 - min(thickness, 1.0));
  float stripe = fract((gl_FragCoord.x + gl_FragCoord.y) / ${(3 * STRIPE_PX).toFixed(1)});
  return linear(stripe < 0.67 ? vec3(0.78, 0.05, 0.16) : vec3(1.0));
}
`;
