/** Clicks and hovers over the view, as distinct from drags. */

/** A pointer that moves farther than this while pressed is dragging, CSS pixels. */
export const DRAG_FROM_PX = 4;

/** A finger that is held for longer than this does what a click with Shift does, ms. */
const HELD_MS = 500;

export type Point = readonly [x_px: number, y_px: number];

export interface PointerReports {
  /** Called on a press and release in one place with the main button; `isMore` with Shift, or of a finger that was held. */
  clicked(at: Point, isMore: boolean): void;
  /** Called on the same with the secondary button. */
  menu(at: Point): void;
  /** Called with the position of a pointer without a pressed button, at most once per frame; null when it has left. */
  hovered(at: Point | null): void;
}

/** Position of a pointer relative to the upper left corner of a surface. */
export function placeIn(surface: HTMLElement, { clientX, clientY }: PointerEvent): Point {
  const { left, top } = surface.getBoundingClientRect();
  return [clientX - left, clientY - top];
}

/** Watches `surface` until the signal is aborted. */
export function watchPointer(surface: HTMLElement, reports: PointerReports, signal: AbortSignal): void {
  let down: { readonly id: number; readonly at: Point; readonly since_ms: number } | null = null;
  let latest: Point | null = null;
  let asked = false;
  const place = (event: PointerEvent): Point => placeIn(surface, event);
  const hover = (at: Point | null): void => {
    latest = at;
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      if (!signal.aborted) reports.hovered(latest);
    });
  };
  const options = { signal };
  surface.addEventListener(
    "pointerdown",
    (event) => {
      down = event.isPrimary && (event.button === 0 || event.button === 2) ? { id: event.pointerId, at: place(event), since_ms: event.timeStamp } : null;
    },
    options,
  );
  surface.addEventListener(
    "pointermove",
    (event) => {
      if (event.buttons === 0) hover(place(event));
    },
    options,
  );
  surface.addEventListener("pointerleave", () => hover(null), options);
  surface.addEventListener(
    "pointerup",
    (event) => {
      const at = place(event);
      if (down?.id !== event.pointerId) return;
      if (Math.hypot(at[0] - down.at[0], at[1] - down.at[1]) <= DRAG_FROM_PX) {
        if (event.button === 2) reports.menu(at);
        else reports.clicked(at, event.shiftKey || (event.pointerType === "touch" && event.timeStamp - down.since_ms > HELD_MS));
      }
      down = null;
    },
    options,
  );
  surface.addEventListener("pointercancel", () => (down = null), options);
}
