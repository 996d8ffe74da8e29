/** Pose of a model on the plate: rotated by a unit quaternion, centred, its lowest point at z = 0. */
import { Quaternion, Vector3 } from "three";

export { UPRIGHT } from "./turn.js";

/** Unit quaternion [x, y, z, w] that rotates the model before it is placed on the plate. */
export type Rotation = readonly [x: number, y: number, z: number, w: number];

export type Triple = readonly [x: number, y: number, z: number];

/** Bounds of the rotated and scaled model, mm, before it is placed on the plate. */
export interface Extent {
  readonly least: Triple;
  readonly greatest: Triple;
}

/** Nine entries of the rotation matrix times `scale`, row by row. */
function matrixOf([x, y, z, w]: Rotation, scale: number): readonly number[] {
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y - z * w),
    2 * (x * z + y * w),
    2 * (x * y + z * w),
    1 - 2 * (x * x + z * z),
    2 * (y * z - x * w),
    2 * (x * z - y * w),
    2 * (y * z + x * w),
    1 - 2 * (x * x + y * y),
  ].map((entry) => entry * scale);
}

/** Bounds of `points` (three numbers each, mm) once rotated and scaled. One pass; zeros without points. */
export function extentOf(points: Float32Array, rotation: Rotation, scale: number): Extent {
  if (points.length < 3) return { least: [0, 0, 0], greatest: [0, 0, 0] };
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0] = matrixOf(rotation, scale);
  let [x0, y0, z0] = [Infinity, Infinity, Infinity];
  let [x1, y1, z1] = [-Infinity, -Infinity, -Infinity];
  // Runs millions of times, so it does not destructure arrays.
  for (let at = 0; at + 2 < points.length; at += 3) {
    const x = points[at] ?? 0;
    const y = points[at + 1] ?? 0;
    const z = points[at + 2] ?? 0;
    const px = a * x + b * y + c * z;
    const py = d * x + e * y + f * z;
    const pz = g * x + h * y + i * z;
    if (px < x0) x0 = px;
    if (px > x1) x1 = px;
    if (py < y0) y0 = py;
    if (py > y1) y1 = py;
    if (pz < z0) z0 = pz;
    if (pz > z1) z1 = pz;
  }
  return { least: [x0, y0, z0], greatest: [x1, y1, z1] };
}

/** Offset that moves the rotated and scaled points to the middle of the plate. */
export function standing({ least, greatest }: Extent): Triple {
  return [-(least[0] + greatest[0]) / 2, -(least[1] + greatest[1]) / 2, -least[2]];
}

export const sizeOf = ({ least, greatest }: Extent): Triple => [
  greatest[0] - least[0],
  greatest[1] - least[1],
  greatest[2] - least[2],
];

/** The points rotated, scaled and placed on the plate. */
export function posed(points: Float32Array, rotation: Rotation, scale: number): Float32Array {
  const [a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, g = 0, h = 0, i = 0] = matrixOf(rotation, scale);
  const [ox, oy, oz] = standing(extentOf(points, rotation, scale));
  const out = new Float32Array(points.length);
  for (let at = 0; at + 2 < points.length; at += 3) {
    const x = points[at] ?? 0;
    const y = points[at + 1] ?? 0;
    const z = points[at + 2] ?? 0;
    out[at] = a * x + b * y + c * z + ox;
    out[at + 1] = d * x + e * y + f * z + oy;
    out[at + 2] = g * x + h * y + i * z + oz;
  }
  return out;
}

const packed = ({ x, y, z, w }: Quaternion): Rotation => [x, y, z, w];

/** `rotation` followed by the shortest turn that points `normal`, a unit vector in the file's pose, straight down. */
export function layFlat(rotation: Rotation, normal: Triple): Rotation {
  const before = new Quaternion(...rotation);
  const turned = new Vector3(...normal).applyQuaternion(before);
  const turn = new Quaternion().setFromUnitVectors(turned.normalize(), new Vector3(0, 0, -1));
  return packed(turn.multiply(before).normalize());
}

/** `rotation` followed by a turn about one of the plate's axes, counter-clockwise as seen from the axis's end. */
export function turned(rotation: Rotation, axis: "x" | "y" | "z", degrees: number): Rotation {
  const about = new Vector3();
  about[axis] = 1;
  const turn = new Quaternion().setFromAxisAngle(about, (degrees * Math.PI) / 180);
  return packed(turn.multiply(new Quaternion(...rotation)).normalize());
}
