/** Detects by their positions that a plot is next to the view, and computes the insets that align heights with it. */
import type { Inset } from "./cameras.js";

/** Upper and lower edge of an element, CSS pixels. */
export type Edges = Pick<DOMRectReadOnly, "top" | "bottom">;

/** Tolerance for edges at fractions of a pixel. */
const ROUNDING_PX = 1;

/** Room in the view above and below the plot; null if the plot is above, below or taller than the view, or not shown. */
export function besideOf(view: Edges, plot: Edges): Inset | null {
  const inset = { top_px: plot.top - view.top, bottom_px: view.bottom - plot.bottom };
  const isBeside = plot.bottom > plot.top && inset.top_px >= -ROUNDING_PX && inset.bottom_px >= -ROUNDING_PX;
  return isBeside ? inset : null;
}

/** Observes the layout of the view and a plot. */
export class Beside {
  readonly #view: HTMLElement;
  readonly #resized: ResizeObserver;
  #plot: HTMLElement | null = null;

  /** @param changed called when either is resized: after layout, but before the browser paints */
  constructor(view: HTMLElement, changed: () => void, signal: AbortSignal) {
    this.#view = view;
    this.#resized = new ResizeObserver(changed);
    this.#resized.observe(view);
    signal.addEventListener("abort", () => this.#resized.disconnect());
  }

  set plot(plot: HTMLElement | null) {
    if (this.#plot !== null) this.#resized.unobserve(this.#plot);
    this.#plot = plot;
    if (plot !== null) this.#resized.observe(plot);
  }

  /** Insets in the current layout; undefined without a plot, null if it is not next to the view. */
  get inset(): Inset | null | undefined {
    return this.#plot === null ? undefined : besideOf(this.#view.getBoundingClientRect(), this.#plot.getBoundingClientRect());
  }
}
