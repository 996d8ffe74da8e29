/** Properties of the view, and the state that it renders. */
import type { Heights, Inset } from "./scene/cameras.js";
import { BRUSH } from "./paint/brush.js";
import type { ViewPoint } from "./points/markers.js";
import type { Tool } from "./scene/keys.js";
import type { Copy } from "./scene/copies.js";
import type { Heat } from "./paint/heat.js";
import type { Mark } from "./scene/marker.js";
import type { Look } from "./scene/model.js";
import type { BuildVolume } from "./scene/plate.js";
import { UPRIGHT, type Rotation } from "./scene/pose.js";
import { ENGLISH } from "./texts.js";
import { given, own } from "./properties.js";
import type { Walls } from "./walls/thickness.js";

export const PROPERTIES = {
  /** Nine numbers per facet, mm, in the file's pose; a new array is a new model. */
  positions: given<Float32Array | null>(null),
  /** Rotates the model before it is placed on the plate. Ignored while the model is being dragged by its rings. */
  rotation: given<Rotation>(UPRIGHT),
  /** Factor applied to the file's lengths. */
  scale: given(1),
  /** Lift of the model above the plate, mm. */
  lift_mm: given(0),
  /** Vertex positions of its supports, nine numbers per facet, mm, z from the plate; null without supports. */
  supports: given<Float32Array | null>(null),
  /** Vertex positions of the walls of its void, likewise, shown by the tool `drains`; null for a solid model. */
  voids: given<Float32Array | null>(null),
  /** Points shown and placed by the tools `supports` and `drains`. */
  points: given<readonly ViewPoint[]>([]),
  /** Index of the selected point. */
  point: given<number | null>(null),
  /** Layer boundaries from 0 to the top, mm; empty without a plan. */
  z_mm: given<readonly number[]>([]),
  /** One per layer. */
  thickness_mm: given<readonly number[]>([]),
  /** Thicknesses at the ends of the colour scale, mm. */
  limits: given<readonly [number, number]>([0, 0]),
  /** Index of the selected layer, from 0. */
  layer: given<number | null>(null),
  /** True if everything above the selected layer is cut off. */
  cuts: given(false),
  /** Places to mark; the first is turned to the viewer. */
  marks: given<readonly Mark[]>([]),
  /** Places to outline, in the same frame. */
  places: given<readonly Mark[]>([]),
  /** The printer's build volume; without one, the plate is a grid that fades out. */
  plate: given<BuildVolume | null>(null),
  /** Copies on the plate; the model is the one at `selected`. Empty for a single model in the middle. */
  copies: given<readonly Copy[]>([]),
  /** Index of the copy drawn as the model. */
  selected: given<number | null>(null),
  /** Indices of all selected copies. */
  chosen: given<readonly number[]>([]),
  look: given<Look>("thickness"),
  tool: given<Tool>("turn"),
  /**
   * Shows the front without perspective, so that a height is a row of pixels: see `cusp-frame`. No effect if there is a plot that is not
   * next to the view.
   */
  aligned: given(false),
  /** Heights shown when aligned; null for the whole model. */
  heights_mm: given<Heights | null>(null),
  /** Element with which the view aligns: its lower and upper edge are the ends of `heights_mm`. Its position is read in every frame. */
  plot: given<HTMLElement | null>(null),
  /** Room above and below those heights when aligned without a plot. */
  inset: given<Inset>({ top_px: 12, bottom_px: 12 }),
  /** True to move the camera near the largest stair steps on the side facing the viewer. Needs a plan. */
  near: given(false),
  /** Painted weight of each facet, 0 to 1; null: all 1. Ignored during a stroke. */
  weights: given<Float32Array | null>(null),
  /** Saliency of each facet, 0 to 1; null: all 1. */
  saliency: given<Float32Array | null>(null),
  /** Quantity shown by the look `weights`. */
  heat: given<Heat>("paint"),
  /** Minimum of the product of weight and saliency, if that is shown. */
  least: given(0),
  /** Thickness below which the look `walls` marks walls, mm. */
  wall_mm: given(0),
  brush: given(BRUSH),
  showsLegend: given(true),
  texts: given(ENGLISH),
  /** Progress of computing the stair steps, 0 to 1; null when idle. */
  building: own<number | null>(null),
  /** Progress of measuring their distances from the model, likewise. */
  measuring: own<number | null>(null),
  /** Largest of these distances, mm; null until measured. */
  greatest_mm: own<number | null>(null),
  /** Progress of measuring the wall thickness, likewise. */
  probing: own<number | null>(null),
  /** Wall thickness of the model, in the file's lengths; null until measured. */
  walls: own<Walls | null>(null),
  /** True if the plot is next to the view; null without a plot. */
  isBeside: own<boolean | null>(null),
  /** True if WebGL is missing. */
  broken: own(false),
  /** True if the browser has taken the WebGL context away. */
  lost: own(false),
};
