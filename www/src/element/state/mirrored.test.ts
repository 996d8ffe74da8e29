import { expect, test } from "vitest";
import { turn } from "../../view/scene/turn.js";
import { mirroredPose } from "./mirrored.js";
import { placedFrom } from "./placed.js";
import { DEFAULT_SETTINGS, quaternion } from "./settings.js";

test("a mirrored pose shows the mirrored file as the mirror image of what stood", () => {
  const settings = { ...DEFAULT_SETTINGS, rotation: "0.1,0.2,0.3,0.9", height: "20" };
  const { rotation, height } = mirroredPose(settings);
  expect(height).toBe("20");
  const [before, after] = [quaternion(settings.rotation), quaternion(rotation)];
  if (before === null || after === null) throw new Error("no rotation");
  const [x, y, z] = turn(before, [1, 2, 3]);
  const image = turn(after, [-1, 2, 3]);
  for (const [i, part] of [-x, y, z].entries()) expect(image[i]).toBeCloseTo(part, 5);
  expect(mirroredPose({ ...settings, rotation: "" }).rotation).toBe("");
});

test("points and holes keep to the surface", () => {
  const { points, drains } = mirroredPose({ ...DEFAULT_SETTINGS, points: "1,2,3,,1", drains: "1,2,3,1,0,0,2,0" });
  expect(placedFrom(points, "points")?.[0]).toMatchObject({ at_mm: [-1, 2, 3], isLocked: true });
  expect(placedFrom(drains, "drains")?.[0]).toMatchObject({ at_mm: [-1, 2, 3], inward: [-1, 0, 0], diameter_mm: 2 });
  expect(mirroredPose({ ...DEFAULT_SETTINGS, points: "none" }).points).toBe("none");
});
