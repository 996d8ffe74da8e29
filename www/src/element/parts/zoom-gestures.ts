/** Gestures that zoom and move the heights of a chart: two fingers, a trackpad pinch, or the wheel with Control. */
import type { Heights } from "./chart.js";

/** The chart that is zoomed. */
export interface Zoomable {
  /** Visible range of heights. */
  shown(): Heights;
  /** Position of a screen point in the plot, 0 at the lower and 1 at the upper edge, and its height. */
  under(clientY: number): readonly [place: number, z_mm: number];
  /** Zooms `from`, by default the visible range, by a factor so that `z_mm` lies at `place`. */
  zoom(factor: number, z_mm: number, place: number, from?: Heights): void;
}

/** Zoom per pixel of wheel movement; browsers report a trackpad pinch as wheel movement with Control. */
const WHEEL_ZOOM = 0.01;

/** A two-finger gesture: initial distance, height between the fingers, and visible range. */
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
    // The first finger of a gesture: any left over missed their end event.
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
    // Without Control, the wheel scrolls the page.
    if (!event.ctrlKey) return;
    event.preventDefault();
    const [place, z_mm] = this.#chart.under(event.clientY);
    this.#chart.zoom(Math.exp(-WHEEL_ZOOM * event.deltaY), z_mm, place);
  };

  /** Keeps the page from scrolling under two fingers, which would end the gesture. */
  readonly touched = (event: TouchEvent): void => {
    if (event.touches.length > 1 && event.cancelable) event.preventDefault();
  };

  /** Forgets the fingers, as when the chart is redrawn. */
  drop(): void {
    this.#fingers.clear();
    this.#pinch = null;
  }

  /** Distance of two fingers and their centre; null for any other number of fingers. */
  #hold(): { apart_px: number; y: number } | null {
    const [a, b, ...more] = this.#fingers.values();
    if (a === undefined || b === undefined || more.length > 0) return null;
    return { apart_px: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)), y: (a.y + b.y) / 2 };
  }
}
