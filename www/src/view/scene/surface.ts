/** WebGL context of the canvas, and placement of the label over it. */

/** Antialiasing quadruples the work, so it is disabled if a software renderer replaces the GPU. */
export function contextOf(canvas: HTMLCanvasElement): WebGL2RenderingContext | null {
  const wanted = { alpha: true, depth: true, stencil: false };
  return (
    canvas.getContext("webgl2", { ...wanted, antialias: true, failIfMajorPerformanceCaveat: true }) ??
    canvas.getContext("webgl2", { ...wanted, antialias: false })
  );
}

/** Gap between the label and its point, CSS pixels. */
const GAP_PX = 12;

/** Places a label to the right of a point, or in its corner of the view if there is no room. Null hides it. */
export function place(label: HTMLElement, at: readonly [x_px: number, y_px: number] | null, width_px: number): void {
  label.hidden = at === null;
  if (at === null) return;
  const [x, y] = at;
  const isBeside = x + 2 * GAP_PX + label.offsetWidth <= width_px;
  label.classList.toggle("beside", isBeside);
  label.style.transform = isBeside ? `translate(${Math.round(x + GAP_PX)}px, calc(${Math.round(y)}px - 50%))` : "";
}
