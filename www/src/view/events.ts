/** The events of the view. */
import type { MoveDetail } from "./scene/moving.js";
import type { Frame } from "./scene/cameras.js";
import type { Rotation, Triple } from "./scene/pose.js";

/** The model was turned, by the rings, by laying a face flat or by keyboard. The view shows it already. */
export interface RotateDetail {
  readonly rotation: Rotation;
  /** False while it is still being turned. */
  readonly final: boolean;
}

/** The height under the pointer; nulls when it has left the model. */
export interface HeightDetail {
  readonly z_mm: number | null;
  /** Counted from 0; null also without a plan. */
  readonly layer: number | null;
}

/** Weights were painted, or a stroke was undone or redone. */
export interface PaintDetail {
  /** 0 to 1 a facet; never changed later. */
  readonly weights: Float32Array;
  /** False while the stroke goes on. */
  readonly final: boolean;
  readonly canUndo: boolean;
  readonly canRedo: boolean;
}

/** A place on the model's surface, in the frame of `points`. */
export interface SurfacePlace {
  readonly at_mm: Triple;
  /** The way into the model there, a unit vector. */
  readonly inward: Triple;
}

/** What somebody wants with the points. The view shows it when `points` and `point` say so. */
export type PointDetail =
  | { readonly do: "add"; readonly to: SurfacePlace }
  /** Once it is released. */
  | { readonly do: "move"; readonly place: number; readonly to: SurfacePlace }
  | { readonly do: "select"; readonly place: number | null }
  | { readonly do: "remove" | "lock"; readonly place: number };

export interface ViewErrorDetail {
  readonly code: "no-webgl";
  readonly message: string;
}

export interface ViewEvents {
  "cusp-rotate": CustomEvent<RotateDetail>;
  "cusp-height": CustomEvent<HeightDetail>;
  /** The layer that was clicked, counted from 0. */
  "cusp-layer": CustomEvent<number>;
  /** Where heights appear, CSS pixels from the view's upper edge; null while the view is not aligned. */
  "cusp-frame": CustomEvent<Frame | null>;
  /** True if the plot is beside the view, so that it could be aligned; fired when that has changed. */
  "cusp-beside": CustomEvent<boolean>;
  /** Rotation of the camera: turns its right, up and backward axes into the plate's frame. */
  "cusp-camera": CustomEvent<Rotation>;
  "cusp-paint": CustomEvent<PaintDetail>;
  /** A copy was moved over the plate. The view shows it when `copies` say so. */
  "cusp-move": CustomEvent<MoveDetail>;
  /** A copy was pressed: its place. */
  "cusp-select": CustomEvent<number>;
  /** A point was added, moved, selected, removed or locked. */
  "cusp-point": CustomEvent<PointDetail>;
  "cusp-view-error": CustomEvent<ViewErrorDetail>;
}
