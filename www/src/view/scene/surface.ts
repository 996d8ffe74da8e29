/** The canvas that is drawn on, and the label that is laid over it. */

/** Smooth edges take four times the work: where a processor does it in place of a GPU, the view goes without. */
export function contextOf(canvas: HTMLCanvasElement): WebGL2RenderingContext | null {
  const wanted = { alpha: true, depth: true, stencil: false };
  return (
    canvas.getContext("webgl2", { ...wanted, antialias: true, failIfMajorPerformanceCaveat: true }) ??
    canvas.getContext("webgl2", { ...wanted, antialias: false })
  );
}

/** Between the label and what it names, CSS pixels. */
const GAP_PX = 12;

/** Puts a label to the right of a point; where there is no room it goes to its corner. Nothing hides it. */
export function place(label: HTMLElement, at: readonly [x_px: number, y_px: number] | null, width_px: number): void {
  label.hidden = at === null;
  if (at === null) return;
  const [x, y] = at;
  const isBeside = x + 2 * GAP_PX + label.offsetWidth <= width_px;
  label.classList.toggle("beside", isBeside);
  label.style.transform = isBeside ? `translate(${Math.round(x + GAP_PX)}px, calc(${Math.round(y)}px - 50%))` : "";
}
