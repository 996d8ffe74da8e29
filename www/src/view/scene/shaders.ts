/** Shaders. Heights are world z, mm; colours are sRGB and lit in linear light. */
import { HEAT_GLSL } from "../paint/heat.js";
import { LAYER_AT_GLSL } from "./lookup.js";
import { MARK_COLOUR } from "./marker.js";
import { PALETTE_SIZE } from "../legend/palette.js";
import { WALLS_GLSL } from "../walls/colours.js";

/** Colour of the section of a model that is cut, which is in no scale. */
const SECTION = [0.95, 0.96, 0.98] as const;

/** Maximum number of boxes whose surface is painted: each pixel is compared with all. */
export const MOST_MARKS = 32;

const vec3 = (parts: readonly number[]): string => `vec3(${parts.join(", ")})`;

const HEAD = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
`;

const MATRICES = /* glsl */ `
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
`;

export const MODEL_VERTEX = /* glsl */ `${HEAD}${MATRICES}
out vec3 world;
out vec3 eye;
#if defined(BY_HEAT) || defined(BY_WALLS)
flat out int facet;
#endif
#ifdef BY_WALLS
out vec3 corners;
#endif
#ifdef BY_DISTANCE
in float away;
out float apart;
#endif
void main() {
#if defined(BY_HEAT) || defined(BY_WALLS)
  facet = gl_VertexID / 3;
#endif
#ifdef BY_WALLS
  int corner = gl_VertexID % 3;
  corners = vec3(corner == 0, corner == 1, corner == 2);
#endif
#ifdef BY_DISTANCE
  apart = away;
#endif
  vec4 at = modelMatrix * vec4(position, 1.0);
  world = at.xyz;
  at = viewMatrix * at;
  eye = at.xyz;
  gl_Position = projectionMatrix * at;
}
`;

/**
 * Shows resin, or layers: a pixel has the mean thickness of the layers that it covers, as in the chart. Layers thinner than a pixel
 * therefore blend instead of flickering, and the shader looks up only boundaries.
 *
 * With `BY_HEAT`, `BY_DISTANCE` or `BY_WALLS` defined, it shows that instead; with `MARKED`, what is in a box is painted. They are separate variants because software WebGL runs every
 * branch for every pixel.
 */
export const MODEL_FRAGMENT = /* glsl */ `${HEAD}
uniform mat4 viewMatrix;
uniform sampler2D boundaries;
uniform int layers;
uniform float cellsPerMm;
uniform sampler2D palette;
uniform vec2 limits;
uniform bool byThickness;
uniform vec3 resin;
uniform vec2 band;
uniform float opacity;
uniform float cut;
in vec3 world;
in vec3 eye;
out vec4 colour;
${LAYER_AT_GLSL}
vec3 linear(vec3 srgb) {
  return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), step(0.04045, srgb));
}

vec3 encoded(vec3 light) {
  light = clamp(light, 0.0, 1.0);
  return mix(light * 12.92, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, light));
}

/** Key light from the upper left, fill from the right, a rim from behind; sky above and the plate's glow below. */
vec3 lit(vec3 base, vec3 normal) {
  float sky = 0.5 + 0.5 * dot(normal, viewMatrix[2].xyz);
  float key = 0.5 + 0.5 * dot(normal, normalize(vec3(-0.45, 0.6, 0.66)));
  float fill = max(dot(normal, normalize(vec3(0.75, 0.05, 0.66))), 0.0);
  float rim = pow(1.0 - clamp(normal.z, 0.0, 1.0), 3.0);
  float light = 0.16 + 0.24 * sky + 0.58 * key * key + 0.14 * fill;
  return base * light + vec3(0.1) * rim * sky;
}

// A horizontal face on a boundary belongs to the layer inside the model, hence half a micrometre inwards: less than any
// plan resolves.
const float INWARDS = 0.0005;

vec3 ofPlan(float width, float upwards) {
  float z = world.z - INWARDS * upwards;
  int first = layerAt(z - 0.5 * width);
  float bottom = boundary(first);
  float top = boundary(first + 1);
  int last = first;
  if (z + 0.5 * width >= top) {
    last = layerAt(z + 0.5 * width);
    top = boundary(last + 1);
  }
  float thickness = (top - bottom) / float(last - first + 1);
  float span = limits.y - limits.x;
  float place = span > 0.0 ? clamp((thickness - limits.x) / span, 0.0, 1.0) : 0.5;
  vec3 base = texelFetch(palette, ivec2(int(place * ${(PALETTE_SIZE - 1).toFixed(1)} + 0.5), 0), 0).rgb;
  // Draw a seam between layers tall enough to tell apart, but not across a horizontal face.
  float pixels = thickness / max(width, 1e-9);
  float nearest = min(z - bottom, top - z) / max(width, 1e-9);
  float seam = (1.0 - smoothstep(0.2, 1.0, nearest)) * smoothstep(5.0, 10.0, pixels);
  seam *= 1.0 - smoothstep(0.99, 0.999, abs(upwards));
  return linear(base) * (1.0 - (first == last ? 0.45 : 0.0) * seam);
}

#if defined(BY_HEAT) || defined(BY_DISTANCE) || defined(BY_WALLS)

/** The palette's first entry is the greatest heat, as it is the thinnest layer. */
vec3 ofHeat(float heat) {
  return linear(texelFetch(palette, ivec2(int((1.0 - heat) * ${(PALETTE_SIZE - 1).toFixed(1)} + 0.5), 0), 0).rgb);
}

#endif
#if defined(BY_WALLS)
flat in int facet;
in vec3 corners;
${WALLS_GLSL}
vec3 base(float width, float upwards) {
  return ofWall(wallAt(facet, corners));
}
#elif defined(BY_HEAT)
flat in int facet;
uniform sampler2D heat;
${HEAT_GLSL}
vec3 base(float width, float upwards) {
  return ofHeat(heatAt(facet));
}
#elif defined(BY_DISTANCE)
in float apart;
uniform float greatest;
vec3 base(float width, float upwards) {
  return ofHeat(clamp(apart / greatest, 0.0, 1.0));
}
#else
vec3 base(float width, float upwards) {
  return byThickness ? ofPlan(width, upwards) : linear(resin);
}
#endif

#ifdef MARKED
uniform int marks;
uniform vec3 markLow[${MOST_MARKS}];
uniform vec3 markHigh[${MOST_MARKS}];

bool isMarked() {
  for (int i = 0; i < marks; i++) {
    if (all(greaterThanEqual(world, markLow[i])) && all(lessThanEqual(world, markHigh[i]))) return true;
  }
  return false;
}
#endif

void main() {
#ifdef CUT
  if (world.z > cut) discard;
#ifdef VOID
  // Only from inside: from outside, solid material is around it.
  if (gl_FrontFacing) discard;
#else
  // Behind the surface is the inside: flat, it looks like the section.
  if (!gl_FrontFacing) {
    colour = vec4(${vec3(SECTION)}, opacity);
    return;
  }
#endif
#endif
  // The range of heights that this pixel covers.
  float width = fwidth(world.z);
  vec3 normal = normalize(cross(dFdx(eye), dFdy(eye)));
  float upwards = dot(normal, viewMatrix[2].xyz);
  vec3 own = base(width, upwards);
#ifdef MARKED
  if (isMarked()) own = mix(own, linear(${vec3([16, 8, 0].map((bits) => ((MARK_COLOUR >> bits) & 255) / 255))}), 0.8);
#endif
  vec3 light = lit(own, normal);
  vec3 shown = encoded(light);
  if (band.y > band.x) {
    // The selected layer: at least three pixels high, and dark with a light edge to stand out anywhere.
    float grown = max(0.0, 1.5 * width - 0.5 * (band.y - band.x));
    float z = world.z - INWARDS * upwards;
    float inside = min(z - band.x, band.y - z) + grown;
    float edge = inside / max(width, 1e-9);
    float tall = smoothstep(6.0, 12.0, (band.y - band.x) / max(width, 1e-9));
    if (edge > 0.0) shown = mix(shown, vec3(0.06, 0.07, 0.1), mix(0.94, edge < 2.0 ? 0.94 : 0.3, tall));
    else if (edge > -1.5) shown = mix(shown, vec3(1.0), 0.85);
  }
  colour = vec4(shown, opacity);
}
`;

/** Facet under a pixel, as its number plus one in four bytes; zero means no facet. */
export const PICK_VERTEX = /* glsl */ `${HEAD}${MATRICES}
flat out uint facet;
out float height;
void main() {
  facet = uint(gl_VertexID / 3 + 1);
  vec4 world = modelMatrix * vec4(position, 1.0);
  height = world.z;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`;

export const PICK_FRAGMENT = /* glsl */ `${HEAD}
uniform float cut;
flat in uint facet;
in float height;
out vec4 colour;
void main() {
  if (height > cut) discard;
  colour = vec4(uvec4(facet, facet >> 8u, facet >> 16u, facet >> 24u) & 255u) / 255.0;
}
`;

/** Closeness of the model to the plate, seen from below: the source of the shadow. */
export const SHADOW_VERTEX = /* glsl */ `${HEAD}${MATRICES}
uniform float reach;
out float near;
void main() {
  vec4 at = modelMatrix * vec4(position, 1.0);
  near = 1.0 - at.z / reach;
  gl_Position = projectionMatrix * viewMatrix * at;
}
`;

export const SHADOW_FRAGMENT = /* glsl */ `${HEAD}
in float near;
out vec4 colour;
void main() {
  colour = vec4(clamp(near, 0.0, 1.0));
}
`;

export const BLUR_VERTEX = /* glsl */ `${HEAD}
in vec3 position;
out vec2 place;
void main() {
  place = position.xy + 0.5;
  gl_Position = vec4(2.0 * position.xy, 0.0, 1.0);
}
`;

/** Blurs the shadow with rings of samples from a coarser mipmap level. */
export const BLUR_FRAGMENT = /* glsl */ `${HEAD}
uniform sampler2D sharp;
in vec2 place;
out vec4 colour;
void main() {
  float sum = 0.0;
  for (int ring = 1; ring <= 3; ring++) {
    for (int i = 0; i < 12; i++) {
      float angle = (float(i) + 0.33 * float(ring)) * 0.5235988;
      sum += textureLod(sharp, place + 0.014 * float(ring) * vec2(cos(angle), sin(angle)), 2.0).a;
    }
  }
  colour = vec4(sum / 36.0);
}
`;

export const PLATE_VERTEX = /* glsl */ `${HEAD}${MATRICES}
out vec2 at;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`;

/** A grid of thin lines, every fifth one stronger, a soft shadow, and an edge that is sharp or fades out. */
export const PLATE_FRAGMENT = /* glsl */ `${HEAD}
uniform vec3 ink;
uniform float step_mm;
uniform vec2 half_mm;
uniform bool hasEdge;
uniform sampler2D shadow;
uniform float shadowHalf_mm;
uniform float shadowStrength;
in vec2 at;
out vec4 colour;

float lines(float pitch) {
  vec2 width = fwidth(at);
  vec2 away = abs(fract(at / pitch + 0.5) - 0.5) * pitch;
  vec2 drawn = 1.0 - smoothstep(vec2(0.3), vec2(1.1), away / width);
  // Lines only a few pixels apart merge into grey: fade them out before that.
  drawn *= 1.0 - smoothstep(0.08, 0.3, width / pitch);
  return max(drawn.x, drawn.y);
}

float shade() {
  vec2 place = at / (2.0 * shadowHalf_mm) + 0.5;
  // Outside the texture, the pixels of its edge would repeat.
  vec2 inner = step(abs(place - 0.5), vec2(0.5));
  return inner.x * inner.y * texture(shadow, place).a;
}

void main() {
  float grid = max(0.1 * lines(step_mm), 0.2 * lines(5.0 * step_mm));
  vec2 inner = half_mm - abs(at);
  float fade = 1.0 - smoothstep(0.55, 1.0, length(at) / half_mm.x);
  if (hasEdge) {
    vec2 away = inner / fwidth(at);
    float border = 1.0 - smoothstep(0.5, 1.6, min(away.x, away.y));
    grid = max(grid, 0.4 * border);
    fade = 1.0;
  }
  float dark = shadowStrength * shade();
  float lineAlpha = grid * fade;
  // The shadow lies over the lines; both are laid over whatever the page has behind the view.
  float alpha = dark + lineAlpha * (1.0 - dark);
  colour = vec4(ink * lineAlpha * (1.0 - dark), alpha);
}
`;
