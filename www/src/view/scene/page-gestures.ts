/** Which wheel turns and touches are the page's, and which the view's. */

/** @param isChosen whether the view has the focus */
export function sharePage(holder: HTMLElement, isChosen: () => boolean, signal: AbortSignal): void {
  // The wheel scrolls the page until the view has the focus, by a click or by keyboard.
  const wheel = (event: WheelEvent): void => {
    if (!isChosen() && !event.ctrlKey) event.stopPropagation();
  };
  // Browsers scroll the page with two fingers, too; here they zoom and pan.
  const touch = (event: TouchEvent): void => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  };
  holder.addEventListener("wheel", wheel, { capture: true, signal });
  holder.addEventListener("touchstart", touch, { passive: false, signal });
}
