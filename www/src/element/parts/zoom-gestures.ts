/** Zooming and moving the heights of a chart: two fingers, a pinch on a trackpad, the wheel with Control. */
import type { Heights } from "./chart.js";

/** The chart that is zoomed. */
export interface Zoomable {
  /** The heights on show. */
  shown(): Heights;
  /** The place of a point on the screen, 0 the lower and 1 the upper edge of the plot, and the height there. */
  under(clientY: number): readonly [place: number, z_mm: number];
  /** Enlarges `from`, or what is on show, by a factor, and moves it so that a height lies at a place. */
  zoom(factor: number, z_mm: number, place: number, from?: Heights): void;
}

/** How much a turn of the wheel enlarges, per pixel; browsers report a pinch on a trackpad as such a turn, with Control. */
const WHEEL_ZOOM = 0.01;

/** Two fingers: their distance, the height between them, and what was on show when the second came down. */
interface Pinch {
  apart_px: number;
  z_mm: number;
  from: Heights;
}

export class ZoomGestures {
  readonly #chart: Zoomable;
  readonly #fingers = new Map<number, { x: number; y: number }>();
  #pinch: Pinch | null = null;

  constructor(chart: Zoomable) {
    this.#chart = chart;
  }

  readonly down = ({ pointerType, isPrimary, pointerId, clientX: x, clientY: y }: PointerEvent): void => {
    if (pointerType !== "touch") return;
    // The first finger: one whose end was missed is not there any more.
    if (isPrimary) this.drop();
    this.#fingers.set(pointerId, { x, y });
    const hold = this.#hold();
    this.#pinch = hold === null ? null : { apart_px: hold.apart_px, z_mm: this.#chart.under(hold.y)[1], from: this.#chart.shown() };
  };

  readonly moved = ({ pointerId, clientX: x, clientY: y }: PointerEvent): void => {
    if (!this.#fingers.has(pointerId)) return;
    this.#fingers.set(pointerId, { x, y });
    const [hold, pinch] = [this.#hold(), this.#pinch];
    if (hold === null || pinch === null) return;
    this.#chart.zoom(hold.apart_px / pinch.apart_px, pinch.z_mm, this.#chart.under(hold.y)[0], pinch.from);
  };

  readonly up = ({ pointerId }: PointerEvent): void => {
    this.#fingers.delete(pointerId);
    this.#pinch = null;
  };

  readonly wheeled = (event: WheelEvent): void => {
    // Otherwise the wheel scrolls the page.
    if (!event.ctrlKey) return;
    event.preventDefault();
    const [place, z_mm] = this.#chart.under(event.clientY);
    this.#chart.zoom(Math.exp(-WHEEL_ZOOM * event.deltaY), z_mm, place);
  };

  /** Keeps the page from scrolling under two fingers, which would end their gesture. */
  readonly touched = (event: TouchEvent): void => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  };

  /** Forgets the fingers, as when the chart is drawn anew. */
  drop(): void {
    this.#fingers.clear();
    this.#pinch = null;
  }

  /** The distance of two fingers, and the middle between them; null if there are more or fewer. */
  #hold(): { apart_px: number; y: number } | null {
    const [a, b, ...more] = this.#fingers.values();
    if (a === undefined || b === undefined || more.length > 0) return null;
    return { apart_px: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)), y: (a.y + b.y) / 2 };
  }
}
