/** Drags that a tool of the view takes over from the camera. */
import type { Point } from "./pointer.js";

/** Handlers of a tool for drags. */
export interface Drags {
  /** Returns true if the tool handles the drag that begins here; otherwise the camera does. */
  begin(at: Point, event: PointerEvent): boolean;
  follow(at: Point): void;
  /** @param isDone true if the pointer was released, false if the drag was cancelled */
  end(at: Point, isDone: boolean): void;
}

/** Watches drags with the main button over `holder`, before the camera's controls receive them, until the signal is aborted. */
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
