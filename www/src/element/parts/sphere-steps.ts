/** Moves between directions on the sphere with the arrow keys. */
import type { Triple } from "../../view/scene/pose.js";

export type Way = "left" | "right" | "up" | "down";

/** Step in degrees of the search for the next direction. */
const LOOK_DEG = 2;
const RADIANS = Math.PI / 180;

/** A direction in the viewer's frame, moved by `degrees`: around the vertical, or up or down, at most to the pole. */
export function moved([x, y, z]: Triple, way: Way, degrees: number): Triple {
  const angle = degrees * RADIANS;
  if (way === "left" || way === "right") {
    const [c, s] = [Math.cos(angle), way === "right" ? Math.sin(angle) : -Math.sin(angle)];
    return [c * x + s * z, y, c * z - s * x];
  }
  const height = Math.asin(Math.max(-1, Math.min(1, y)));
  const turned = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, height + (way === "up" ? angle : -angle)));
  const around = Math.atan2(x, z);
  return [Math.cos(turned) * Math.sin(around), Math.sin(turned), Math.cos(turned) * Math.cos(around)];
}

/** Moves sideways from the top or the bottom, where rotating about the vertical has no effect. */
function aside([, y]: Triple, way: Way, degrees: number): Triple {
  const angle = degrees * RADIANS;
  return [way === "left" ? -Math.sin(angle) : Math.sin(angle), Math.sign(y) * Math.cos(angle), 0];
}

/** Index of the first other direction in this way; that of `from` if there is none. */
export function stepped(from: Triple, way: Way, indexOf: (seen: Triple) => number): number {
  const start = indexOf(from);
  const isAcross = way === "left" || way === "right";
  for (const move of isAcross ? [moved, aside] : [moved]) {
    for (let degrees = LOOK_DEG; degrees < 180; degrees += LOOK_DEG) {
      const index = indexOf(move(from, way, degrees));
      if (index !== start) return index;
    }
  }
  return start;
}
