/** Zoom and position of a mask: its visible part and the scale. */
import type { Rectangle } from "./bitmap.js";

export interface Place {
  /** Zoom factor; 1 shows the whole mask. */
  zoom: number;
  /** The point at the centre of the screen, as fractions of width and height. */
  centre: readonly [number, number];
}

export const WHOLE: Place = { zoom: 1, centre: [0.5, 0.5] };

const MOST_ZOOM = 64;

export interface Window {
  /** The visible part of the mask, in its pixels; may extend beyond its edges. */
  part: Rectangle;
  /** Screen pixels per mask pixel, horizontally and vertically. */
  scale: readonly [number, number];
}

/** Visible part of a mask on a screen. `pitch` is the height of a mask pixel divided by its width. */
export function windowOf(place: Place, mask: readonly [number, number], screen: readonly [number, number], pitch: number): Window {
  const fit = Math.min(screen[0] / mask[0], screen[1] / (mask[1] * pitch));
  const scale = [fit * place.zoom, fit * place.zoom * pitch] as const;
  const [width, height] = [screen[0] / scale[0], screen[1] / scale[1]];
  const start = (part: number, all: number, seen: number): number =>
    seen >= all ? (all - seen) / 2 : Math.min(all - seen, Math.max(0, part * all - seen / 2));
  return {
    part: { x: start(place.centre[0], mask[0], width), y: start(place.centre[1], mask[1], height), width, height },
    scale,
  };
}

/** Multiplies the zoom, within 1 to 64. */
export function zoomed({ zoom, centre }: Place, times: number): Place {
  const next = Math.min(MOST_ZOOM, Math.max(1, zoom * times));
  return next === 1 ? WHOLE : { zoom: next, centre };
}

/** Room around what is fitted, as a factor. */
const FIT_ROOM = 1.15;

/** The place that shows a part in the middle of the mask, `extent` pixels wide and high. */
export function fitted(extent: readonly [number, number], mask: readonly [number, number], screen: readonly [number, number], pitch: number): Place {
  const { scale } = windowOf(WHOLE, mask, screen, pitch);
  return zoomed(WHOLE, Math.min(screen[0] / (extent[0] * scale[0]), screen[1] / (extent[1] * scale[1])) / FIT_ROOM);
}

/** A screen point, as fractions of width and height from the top left corner. */
export type Point = readonly [number, number];

/** Multiplies the zoom and moves the point at `from` on the screen to `to`, as far as the edges of the mask allow. */
export function dragged(
  place: Place,
  { times = 1, from, to }: { times?: number; from: Point; to: Point },
  ...[mask, screen, pitch]: [mask: readonly [number, number], screen: readonly [number, number], pitch: number]
): Place {
  const { part } = windowOf(place, mask, screen, pitch);
  const { zoom } = zoomed(place, times);
  if (zoom === 1) return WHOLE;
  const centre = (axis: 0 | 1, start: number, seen: number): number => {
    const half = (seen * place.zoom) / zoom / 2;
    if (2 * half >= mask[axis]) return 0.5;
    const held = start + from[axis] * seen;
    return Math.min(mask[axis] - half, Math.max(half, held + (1 - 2 * to[axis]) * half)) / mask[axis];
  };
  const [x, y] = [centre(0, part.x, part.width), centre(1, part.y, part.height)];
  return { zoom, centre: [x, y] };
}

/** Moves by fractions of the visible part, up to the edges of the mask. */
export function moved({ zoom, centre: [x, y] }: Place, [dx, dy]: readonly [number, number]): Place {
  const inside = (value: number): number => Math.min(1 - 0.5 / zoom, Math.max(0.5 / zoom, value));
  return { zoom, centre: [inside(x + dx / zoom), inside(y + dy / zoom)] };
}
