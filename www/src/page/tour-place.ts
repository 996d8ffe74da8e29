/** Position of the tour's card: next to its target and fully visible. Lengths are in CSS pixels of the window. */

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

const GAP_PX = 12;

/** Narrower windows have no room next to a target. */
const NARROW_PX = 600;

const clamped = (value: number, least: number, most: number): number => Math.max(least, Math.min(value, most));

/**
 * Top left corner of a card: right of its target, left of it, below or above, wherever it fits first; otherwise, and on a phone, at the
 * bottom of the window.
 *
 * @param target null if there is no visible target
 * @param room the window, without fixed content at its bottom
 */
export function placeOf(target: Box | null, card: Size, room: Size): readonly [left: number, top: number] {
  const right = room.width - card.width - GAP_PX;
  const bottom = room.height - card.height - GAP_PX;
  const fallback = [Math.max(0, (room.width - card.width) / 2), Math.max(0, bottom)] as const;
  if (target === null || room.width < NARROW_PX) return fallback;
  const left = clamped(target.left + (target.width - card.width) / 2, GAP_PX, right);
  const top = clamped(target.top + (target.height - card.height) / 2, GAP_PX, bottom);
  const places = [
    [target.left + target.width + GAP_PX, top],
    [target.left - card.width - GAP_PX, top],
    [left, target.top + target.height + GAP_PX],
    [left, target.top - card.height - GAP_PX],
  ] as const;
  return places.find(([x, y]) => x >= 0 && y >= 0 && x <= right && y <= bottom) ?? fallback;
}
