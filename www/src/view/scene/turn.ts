/** Rotates vectors by unit quaternions, for drawing without three.js. */
import type { Rotation, Triple } from "./pose.js";

/** Orientation of the file. */
export const UPRIGHT: Rotation = [0, 0, 0, 1];

/** The rotation by `first`, then by `second`. */
export function combined(first: Rotation, second: Rotation): Rotation {
  const [ax, ay, az, aw] = second;
  const [bx, by, bz, bw] = first;
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

export const back = ([x, y, z, w]: Rotation): Rotation => [-x, -y, -z, w];

export function turn([x, y, z, w]: Rotation, [vx, vy, vz]: Triple): Triple {
  const [tx, ty, tz] = [2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)];
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

export function unit([x, y, z]: Triple): Triple {
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

/** Initial viewing direction: from the front, slightly from the right and above. */
export const FIRST_LOOK: Triple = unit([0.55, -1, 0.5]);

const cross = ([ax, ay, az]: Triple, [bx, by, bz]: Triple): Triple => [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];

/**
 * Rotation of a camera that looks at the model from there with z upwards: it turns the camera's right, up and backward axes into the
 * plate's frame. `from` must not be vertical.
 */
export function lookFrom(from: Triple): Rotation {
  const [zx, zy, zz] = unit(from);
  const [xx, xy, xz] = unit(cross([0, 0, 1], [zx, zy, zz]));
  const [yx, yy, yz] = cross([zx, zy, zz], [xx, xy, xz]);
  // Of the four ways to extract a quaternion from a matrix, this one is stable for views from the front and above.
  const w = Math.sqrt(Math.max(1e-12, 1 + xx + yy + zz)) / 2;
  return [(yz - zy) / (4 * w), (zx - xz) / (4 * w), (xy - yx) / (4 * w), w];
}

/** Height of a model in this rotation, in the unit of its points (three numbers each). */
export function heightOf(points: Float32Array, rotation: Rotation): number {
  const [a, b, c] = turn(back(rotation), [0, 0, 1]);
  let least = Infinity;
  let greatest = -Infinity;
  for (let at = 0; at + 2 < points.length; at += 3) {
    const z = a * (points[at] ?? 0) + b * (points[at + 1] ?? 0) + c * (points[at + 2] ?? 0);
    if (z < least) least = z;
    if (z > greatest) greatest = z;
  }
  return points.length < 3 ? 0 : greatest - least;
}
