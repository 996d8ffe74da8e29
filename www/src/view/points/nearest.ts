/** Finds the marker at a pointer. */
import type { Point } from "../scene/pointer.js";

/** Hit radius of a marker, CSS pixels: for a mouse or pen, and for a finger. */
export const REACH_PX = 12;
export const TOUCH_REACH_PX = 22;

/** Indices of the markers within reach of a pointer, nearest first. */
export function within(at: Point, markers: readonly Point[], reach_px: number): number[] {
  const away = markers.map(([x, y]) => Math.hypot(x - at[0], y - at[1]));
  const near = [...away.keys()].filter((place) => (away[place] ?? Infinity) <= reach_px);
  return near.sort((a, b) => (away[a] ?? 0) - (away[b] ?? 0));
}

/** Next or previous point, cyclically; the first or last if none is selected. Null without points. */
export function stepped(selected: number | null, by: 1 | -1, count: number): number | null {
  if (count === 0) return null;
  if (selected === null || selected >= count) return by > 0 ? 0 : count - 1;
  return (selected + by + count) % count;
}
