/** The pose of a model that is mirrored from left to right as it stands: across x of the plate, while its file is mirrored across its own x. */
import { placedFrom, placedText, NO_POINTS, type PlacedKind } from "./placed.js";
import { quaternion, rotationText, type Settings } from "./settings.js";
import type { Pose } from "./snapshot.js";

export function mirroredPose({ rotation, height, points, fill, drains, drain }: Settings): Pose {
  const [x, y, z, w] = quaternion(rotation) ?? [0, 0, 0, 1];
  const turned = rotation === "" ? "" : rotationText([x, -y, -z, w]);
  return { rotation: turned, height, points: mirroredPoints(points, "points"), fill, drains: mirroredPoints(drains, "drains"), drain };
}

function mirroredPoints(text: string, kind: PlacedKind): string {
  const list = text === NO_POINTS ? null : placedFrom(text, kind);
  if (list === null) return text;
  return placedText(
    list.map(({ at_mm: [x, y, z], inward, ...point }) => ({ ...point, at_mm: [-x, y, z], inward: inward === null ? null : [-inward[0], inward[1], inward[2]] })),
  );
}
