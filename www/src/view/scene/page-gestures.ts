/** Divides wheel and touch gestures between the page and the view. */

/** @param isChosen returns true if the view has the focus */
export function sharePage(holder: HTMLElement, isChosen: () => boolean, signal: AbortSignal): void {
  // The wheel scrolls the page until the view has the focus, by a click or by keyboard.
  const wheel = (event: WheelEvent): void => {
    if (!isChosen() && !event.ctrlKey) event.stopPropagation();
  };
  // Browsers also scroll the page with two fingers; here these zoom and pan.
  const touch = (event: TouchEvent): void => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  };
  holder.addEventListener("wheel", wheel, { capture: true, signal });
  holder.addEventListener("touchstart", touch, { passive: false, signal });
}
