/** Drags that a tool of the view takes from the camera. */
import type { Point } from "./pointer.js";

/** What a tool does with a drag. */
export interface Drags {
  /** Returns whether the tool takes the drag that begins here; otherwise it is the camera's. */
  begin(at: Point, event: PointerEvent): boolean;
  follow(at: Point): void;
  /** @param isDone whether the pointer was released, and not taken away */
  end(at: Point, isDone: boolean): void;
}

/** Watches the main button over `holder` until the signal is aborted, before the camera's controls see it. */
export function watchDrags(holder: HTMLElement, placeOf: (event: PointerEvent) => Point, drags: Drags, signal: AbortSignal): void {
  const options = { capture: true, signal };
  let dragging: number | null = null;
  const down = (event: PointerEvent): void => {
    if (!event.isPrimary || event.button !== 0 || !drags.begin(placeOf(event), event)) return;
    event.stopPropagation();
    holder.setPointerCapture(event.pointerId);
    dragging = event.pointerId;
  };
  const move = (event: PointerEvent): void => {
    if (event.pointerId !== dragging) return;
    event.stopPropagation();
    drags.follow(placeOf(event));
  };
  const up = (event: PointerEvent): void => {
    if (event.pointerId !== dragging) return;
    event.stopPropagation();
    dragging = null;
    drags.end(placeOf(event), event.type === "pointerup");
  };
  holder.addEventListener("pointerdown", down, options);
  holder.addEventListener("pointermove", move, options);
  holder.addEventListener("pointerup", up, options);
  holder.addEventListener("pointercancel", up, options);
}
