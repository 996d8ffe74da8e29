import { expect, test } from "vitest";
import { turned, type Rotation } from "../../view/scene/pose.js";
import { anglesOf, rotationBy } from "./placement-fields.js";

test("typed turns are about x, then y, then z of the plate", () => {
  const upright: Rotation = [0, 0, 0, 1];
  const expected = turned(turned(turned(upright, "x", 20), "y", -35), "z", 110);
  const rotation = rotationBy([20, -35, 110]);
  for (const [i, part] of expected.entries()) expect(rotation[i]).toBeCloseTo(part, 9);
  expect(anglesOf(rotation).map((deg) => deg.toFixed(1))).toEqual(["20.0", "-35.0", "110.0"]);
  expect(anglesOf(upright)).toEqual([0, 0, 0]);
});
