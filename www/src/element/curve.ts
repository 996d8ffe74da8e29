/** Finding one's way on a trade-off curve. */
import type { TradeoffPoint } from "../api/wire.js";

/** The notch of the point whose tolerance is nearest to the plan's, counted from the loosest. */
export function notchOf(points: readonly Pick<TradeoffPoint, "tolerance">[], tolerance: number): number {
  let nearest = 0;
  const distance = (index: number): number => Math.abs((points[index]?.tolerance ?? 0) - tolerance);
  for (let index = 1; index < points.length; index++) if (distance(index) < distance(nearest)) nearest = index;
  return points.length - 1 - nearest;
}
