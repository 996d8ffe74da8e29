import { Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { box, cone } from "../fixtures.js";
import { extentOf, layFlat, posed, sizeOf, turned, UPRIGHT, type Rotation, type Triple } from "./pose.js";

const close = (actual: readonly number[], wanted: readonly number[]): void => {
  expect(actual).toHaveLength(wanted.length);
  for (const [i, value] of wanted.entries()) expect(actual[i]).toBeCloseTo(value, 5);
};

/** Directions of the axes and of the diagonals between them. */
function* directions(): Generator<Triple> {
  for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) {
    const length = Math.hypot(x, y, z);
    if (length > 0) yield [x / length, y / length, z / length];
  }
}

describe("laying a face flat", () => {
  const poses: Rotation[] = [UPRIGHT, turned(UPRIGHT, "x", 90), turned(turned(UPRIGHT, "y", 33), "z", -120)];

  it("turns its normal straight down from any pose", () => {
    for (const before of poses) {
      for (const normal of directions()) {
        const after = layFlat(before, normal);
        expect(Math.hypot(...after)).toBeCloseTo(1, 10);
        const { x, y, z } = new Vector3(...normal).applyQuaternion(new Quaternion(...after));
        close([x, y, z], [0, 0, -1]);
      }
    }
  });

  it("keeps the pose of a model that already lies on that face", () => {
    for (const before of poses) {
      const down = new Vector3(0, 0, -1).applyQuaternion(new Quaternion(...before).invert());
      const after = layFlat(before, [down.x, down.y, down.z]);
      expect(Math.abs(before.reduce((sum, value, i) => sum + value * (after[i] ?? 0), 0))).toBeCloseTo(1, 10);
    }
  });
});

describe("a pose", () => {
  it("stands in the middle of the plate, scaled and turned", () => {
    const points = posed(box([10, 20, 30], [12, 23, 34]), turned(UPRIGHT, "x", 90), 2);
    const { least, greatest } = extentOf(points, UPRIGHT, 1);
    // y has become z, and z has become −y.
    close(least, [-2, -4, 0]);
    close(greatest, [2, 4, 6]);
  });

  it("has the bounds of its points", () => {
    const solid = cone(5, 9, 12);
    const rotation = turned(turned(UPRIGHT, "x", 40), "z", 70);
    const quaternion = new Quaternion(...rotation);
    const points = Array.from({ length: solid.length / 3 }, (_, i) =>
      new Vector3().fromArray(solid, 3 * i).applyQuaternion(quaternion).multiplyScalar(3).toArray(),
    );
    const wanted = [0, 1, 2].map((axis) => {
      const values = points.map((point) => point[axis] ?? 0);
      return Math.max(...values) - Math.min(...values);
    });
    close(sizeOf(extentOf(solid, rotation, 3)), wanted);
  });

  it("turns counter-clockwise as seen from the end of the axis", () => {
    const { x, y, z } = new Vector3(1, 0, 0).applyQuaternion(new Quaternion(...turned(UPRIGHT, "z", 90)));
    close([x, y, z], [0, 1, 0]);
  });

  it("without points has no size", () => {
    expect(sizeOf(extentOf(new Float32Array(0), UPRIGHT, 1))).toEqual([0, 0, 0]);
  });
});
