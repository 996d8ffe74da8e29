/** What the view tells. */
import type { Frame } from "./scene/cameras.js";
import type { Rotation } from "./scene/pose.js";

/** The model was turned, by the rings, by laying a face flat or by keyboard. The view shows it already. */
export interface RotateDetail {
  readonly rotation: Rotation;
  /** False while it is still being turned. */
  readonly final: boolean;
}

/** The height under the pointer; nulls when it has left the model. */
export interface HeightDetail {
  readonly z_mm: number | null;
  /** Counted from 0; null as well where there is no plan. */
  readonly layer: number | null;
}

/** Weights were painted, or a stroke was taken back. */
export interface PaintDetail {
  /** 0 to 1 a facet; written to no more. */
  readonly weights: Float32Array;
  /** False while the stroke goes on. */
  readonly final: boolean;
  readonly canUndo: boolean;
  readonly canRedo: boolean;
}

export interface ViewErrorDetail {
  readonly code: "no-webgl";
  readonly message: string;
}

export interface ViewEvents {
  "cusp-rotate": CustomEvent<RotateDetail>;
  "cusp-height": CustomEvent<HeightDetail>;
  /** The layer that was clicked, counted from 0. */
  "cusp-layer": CustomEvent<number>;
  /** Where heights are, CSS pixels from the view's upper edge; null while the view is not aligned. */
  "cusp-frame": CustomEvent<Frame | null>;
  /** How the camera is turned: it brings its right, up and towards the viewer into the plate's frame. */
  "cusp-camera": CustomEvent<Rotation>;
  "cusp-paint": CustomEvent<PaintDetail>;
  "cusp-view-error": CustomEvent<ViewErrorDetail>;
}
