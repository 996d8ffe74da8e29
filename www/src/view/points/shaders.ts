/**
 * Shaders of the markers. Each is a square of constant size on the screen, drawn in front of its surface. Shapes repeat the information of
 * colours: round or square, with or without a cross, with or without a ring.
 */

/** Bit flags of a marker. */
export const LOCKED = 1;
export const UNREACHED = 2;
export const SELECTED = 4;

/** Half the side of a marker's square, CSS pixels. */
export const HALF_PX = 12;

export const MARKER_VERTEX = /* glsl */ `
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
/** Height of the view, and pixels per CSS pixel. */
uniform vec2 view_px;
in vec3 position;
in float shows;
in float before_mm;
flat out int bits;
void main() {
  bits = int(shows + 0.5);
  vec4 eye = viewMatrix * modelMatrix * vec4(position, 1.0);
  // Nearer by its own size, which leaves it where it is on screen: neither the surface around it nor its hole must cover it.
  float away = max(-eye.z, 1e-6);
  float half_mm = ${HALF_PX.toFixed(1)} * 2.0 * away / (projectionMatrix[1][1] * view_px.x);
  eye.xyz *= max(0.5, 1.0 - (1.5 * half_mm + before_mm) / away);
  gl_Position = projectionMatrix * eye;
  gl_PointSize = 2.0 * ${HALF_PX.toFixed(1)} * view_px.y;
}
`;

export const MARKER_FRAGMENT = /* glsl */ `
precision highp float;
uniform float opacity;
uniform vec2 view_px;
uniform vec3 accent;
uniform vec3 bad;
uniform vec3 chosen;
flat in int bits;
out vec4 colour;

const vec3 PAPER = vec3(1.0);
const vec3 INK = vec3(0.06, 0.07, 0.1);

/** Part of a pixel within a distance. */
float inside(float away) {
  return clamp(0.5 - away * view_px.y, 0.0, 1.0);
}

void main() {
  vec2 at = (gl_PointCoord - 0.5) * 2.0 * ${HALF_PX.toFixed(1)};
  bool isLocked = (bits & ${LOCKED}) != 0;
  bool isUnreached = (bits & ${UNREACHED}) != 0;
  bool isSelected = (bits & ${SELECTED}) != 0;
  float radius = isSelected ? 5.5 : 4.25;
  // A square of about the same area as the circle.
  float away = isLocked ? max(abs(at.x), abs(at.y)) - 0.9 * radius : length(at) - radius;
  // Ink around paper around the colour: one of them stands out from anything behind.
  vec3 fill = isUnreached ? bad : isLocked ? accent : PAPER;
  vec3 shown = mix(PAPER, fill, inside(away + 1.0));
  float cover = inside(away);
  if (isUnreached) {
    float cross = abs(abs(at.x) - abs(at.y)) * 0.7071 - 0.8;
    shown = mix(shown, PAPER, inside(max(cross, away + 0.5)));
  }
  shown = mix(INK, shown, cover);
  cover = inside(away - 1.25);
  if (isSelected) {
    float ring = abs(away - 3.75) - 1.25;
    float around = inside(ring - 1.0) * (1.0 - cover);
    shown = mix(shown, mix(INK, chosen, inside(ring)), around);
    cover = max(cover, around);
  }
  if (cover <= 0.0) discard;
  colour = vec4(shown, cover * opacity);
}
`;
