/** The events of the view. */
import type { MoveDetail, SelectDetail } from "./scene/moving.js";
import type { Frame } from "./scene/cameras.js";
import type { Rotation, Triple } from "./scene/pose.js";

/** The model was turned by the rings, by laying a face flat, or by keyboard. The view already shows it. */
export interface RotateDetail {
  readonly rotation: Rotation;
  /** False during the turn. */
  readonly final: boolean;
}

/** Height under the pointer; nulls when it has left the model. */
export interface HeightDetail {
  readonly z_mm: number | null;
  /** Index of the layer, from 0; also null without a plan. */
  readonly layer: number | null;
}

/** Weights were painted, or a stroke was undone or redone. */
export interface PaintDetail {
  /** Weight of each facet, 0 to 1; never modified later. */
  readonly weights: Float32Array;
  /** False during the stroke. */
  readonly final: boolean;
  readonly canUndo: boolean;
  readonly canRedo: boolean;
}

/** A place on the model's surface, in the frame of `points`. */
export interface SurfacePlace {
  readonly at_mm: Triple;
  /** Direction into the model, a unit vector. */
  readonly inward: Triple;
}

/** An edit of the points requested by the user. The view shows it once `points` and `point` change. */
export type PointDetail =
  | { readonly do: "add"; readonly to: SurfacePlace }
  /** Sent on release. */
  | { readonly do: "move"; readonly place: number; readonly to: SurfacePlace }
  | { readonly do: "select"; readonly place: number | null }
  | { readonly do: "remove" | "lock"; readonly place: number };

/** The model was scaled by its handles or by keyboard, relative to `scale`. */
export interface SizeDetail {
  readonly factor: number;
  /** False during the drag. */
  readonly final: boolean;
}

/** A menu was requested. */
export interface MenuDetail {
  /** Position in the view, CSS pixels. */
  readonly at: readonly [x_px: number, y_px: number];
  /** Index of the copy there; null for none. */
  readonly place: number | null;
}

export interface ViewErrorDetail {
  readonly code: "no-webgl";
  readonly message: string;
}

export type CopiesDetail = "duplicate" | "remove";

export interface ViewEvents {
  "cusp-rotate": CustomEvent<RotateDetail>;
  "cusp-height": CustomEvent<HeightDetail>;
  /** Index of the layer clicked, from 0. */
  "cusp-layer": CustomEvent<number>;
  /** Positions of heights, CSS pixels from the view's upper edge; null while the view is not aligned. */
  "cusp-frame": CustomEvent<Frame | null>;
  /** True if the plot is next to the view, which could align with it; fired on changes. */
  "cusp-beside": CustomEvent<boolean>;
  /** Camera rotation: turns its right, up and backward axes into the plate's frame. */
  "cusp-camera": CustomEvent<Rotation>;
  "cusp-paint": CustomEvent<PaintDetail>;
  "cusp-size": CustomEvent<SizeDetail>;
  /** Copies were moved over the plate. The view shows it once `copies` change. */
  "cusp-move": CustomEvent<MoveDetail>;
  "cusp-select": CustomEvent<SelectDetail>;
  "cusp-menu": CustomEvent<MenuDetail>;
  /** The selected copies are to be duplicated or removed. */
  "cusp-copies": CustomEvent<CopiesDetail>;
  /** A point was added, moved, selected, removed or locked. */
  "cusp-point": CustomEvent<PointDetail>;
  "cusp-view-error": CustomEvent<ViewErrorDetail>;
}
