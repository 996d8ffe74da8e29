/** A small picture of a model in the layers of its plan, for places without room for an element. */
import type { Slicer } from "../../api/index.js";
import { heightOf, UPRIGHT } from "../../view/scene/turn.js";
import { partError } from "./part.js";
import { fetchPictures } from "./pictures.js";
import type { Result } from "../state/result.js";
import { quaternion } from "../state/settings.js";

/** Limits of the side length in pixels. */
const LEAST_PX = 16;
const MOST_PX = 2048;

/**
 * A PNG of the model in the layers of a plan. Rejects with `part-failed` if the renderer cannot be loaded or WebGL is missing.
 *
 * @param height_mm height of the model in the plan
 * @param size_px length of each side in pixels, clamped to 16 to 2048
 */
export async function thumbnailOf(
  slicer: Pick<Slicer, "positions">,
  { report, options, limits }: Result,
  height_mm: number,
  size_px: number,
): Promise<Blob> {
  const drawing = fetchPictures().catch((cause: unknown) => {
    throw partError("pictures", cause);
  });
  const [positions, { thumbnail }] = await Promise.all([slicer.positions(), drawing]);
  const rotation = quaternion((options.rotation ?? []).join()) ?? UPRIGHT;
  const own_mm = heightOf(positions, rotation);
  const picture = {
    ...{ positions, rotation, limits, z_mm: report.z_mm },
    scale: own_mm > 0 ? height_mm / own_mm : 1,
  };
  const side_px = Math.min(MOST_PX, Math.max(LEAST_PX, Math.round(size_px)));
  const png = await thumbnail(picture, side_px);
  if (png === null) throw partError("pictures", "this browser has no WebGL");
  return png;
}
