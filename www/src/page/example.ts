/**
 * Example model: a goblet made by turning a profile about the z axis, its bowl fluted and twisted.
 *
 * It is closed, stands on z = 0 and has every kind of surface relevant to a planner: flats (foot, floor, rim), steep walls (stem, bowl),
 * and slopes from flat to steep (foot, knop, the underside of the bowl).
 */

export const EXAMPLE_NAME = "goblet.stl";

/** Points of the profile as [radius, height, flute], where flute is the strength of the fluting, 0 to 1. Lengths in mm. */
type ProfilePoint = readonly [radius: number, height: number, flute: number];

const AROUND = 90;
const FLUTES = 9;
/** Depth of a flute as a fraction of the radius. */
const FLUTE_DEPTH = 0.055;
/** Twist of the flutes, radians per mm of height. */
const TWIST = 0.035;

const smooth = (t: number): number => t * t * (3 - 2 * t);
const mix = (a: number, b: number, t: number): number => a + (b - a) * t;

/** `steps` points of `at` over 0 < t ≤ 1. */
function along(steps: number, at: (t: number) => ProfilePoint): ProfilePoint[] {
  return Array.from({ length: steps }, (_, i) => at((i + 1) / steps));
}

/** From the middle of the underside, round the outside, to the middle of the floor inside. */
function profile(): ProfilePoint[] {
  const quarter = Math.PI / 2;
  return [
    [0, 0, 0],
    [10.5, 0, 0],
    [10.5, 1, 0],
    // The foot falls away from the stem like a bell.
    ...along(22, (t): ProfilePoint => [mix(10.5, 1.9, Math.sin(t * quarter)), 1 + 4.5 * (1 - Math.cos(t * quarter)), 0]),
    [1.7, 8, 0],
    // The knop: a ball on the stem.
    ...along(18, (t): ProfilePoint => {
      const angle = mix(-1.15, 1.15, t);
      return [0.35 + 3.3 * Math.cos(angle), 11 + 3.3 * Math.sin(angle), 0];
    }),
    [1.7, 14.6, 0],
    // The bowl opens flat, turns upright and leans out a little to the rim.
    ...along(30, (t): ProfilePoint => {
      const angle = t * quarter;
      return [1.7 + 9.8 * Math.sin(angle), 16 + 9 * (1 - Math.cos(angle)), smooth(t)];
    }),
    ...along(40, (t): ProfilePoint => [mix(11.5, 12.6, smooth(t)), mix(25, 40, t), 1]),
    [11.2, 40, 1],
    // Back down inside, the fluting fading towards a flat floor.
    ...along(24, (t): ProfilePoint => [mix(11.2, 9.8, t), mix(40, 26, t), 1 - 0.4 * t]),
    ...along(16, (t): ProfilePoint => {
      const angle = t * quarter;
      return [4 + 5.8 * Math.cos(angle), 26 - 7 * Math.sin(angle), 0.6 * (1 - t)];
    }),
    [0, 19, 0],
  ];
}

/** Triangles of the goblet, nine coordinates each in mm, counter-clockwise from outside. */
export function exampleTriangles(): Float32Array {
  const points = profile();
  const ring = (at: ProfilePoint): Float32Array => {
    const [radius, height, flute] = at;
    const out = new Float32Array(AROUND * 3);
    for (let i = 0; i < AROUND; i++) {
      const angle = (i / AROUND) * 2 * Math.PI;
      const r = radius * (1 + flute * FLUTE_DEPTH * Math.cos(FLUTES * (angle - TWIST * height)));
      // Adding zero turns -0 into 0, so that readers that compare corners bit by bit find a single point on the axis.
      out.set([r * Math.cos(angle) + 0, r * Math.sin(angle) + 0, height], 3 * i);
    }
    return out;
  };

  const rings = points.map(ring);
  const out: number[] = [];
  const corner = (of: Float32Array | undefined, i: number): void => {
    const at = 3 * (i % AROUND);
    if (of !== undefined) out.push(...of.subarray(at, at + 3));
  };
  for (let k = 0; k + 1 < rings.length; k++) {
    const [low, high] = [rings[k], rings[k + 1]];
    // On the axis, a ring is one point, and one of the two triangles would have no area.
    const lowOpen = points[k]?.[0] !== 0;
    const highOpen = points[k + 1]?.[0] !== 0;
    for (let i = 0; i < AROUND; i++) {
      if (lowOpen) {
        corner(low, i);
        corner(low, i + 1);
        corner(high, i);
      }
      if (highOpen) {
        corner(low, i + 1);
        corner(high, i + 1);
        corner(high, i);
      }
    }
  }
  return Float32Array.from(out);
}

/** Binary STL of triangles given as nine coordinates each. Normals stay zero, as readers must expect. */
export function binaryStl(triangles: Float32Array): Uint8Array<ArrayBuffer> {
  const count = triangles.length / 9;
  const bytes = new Uint8Array(84 + 50 * count);
  const view = new DataView(bytes.buffer);
  view.setUint32(80, count, true);
  for (let facet = 0; facet < count; facet++) {
    for (let k = 0; k < 9; k++) view.setFloat32(84 + 50 * facet + 12 + 4 * k, triangles[9 * facet + k] ?? 0, true);
  }
  return bytes;
}
