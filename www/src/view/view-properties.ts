/** The properties of the view, and the state that it renders. */
import type { Heights, Inset } from "./scene/cameras.js";
import { BRUSH } from "./paint/brush.js";
import type { ViewPoint } from "./points/markers.js";
import type { Tool } from "./scene/keys.js";
import type { Copy } from "./scene/copies.js";
import type { Heat } from "./paint/heat.js";
import type { Mark } from "./scene/marker.js";
import type { Look } from "./scene/model.js";
import type { PaletteName } from "./legend/palette.js";
import type { BuildVolume } from "./scene/plate.js";
import { UPRIGHT, type Rotation } from "./scene/pose.js";
import { ENGLISH } from "./texts.js";
import { given, own } from "./properties.js";
import type { Walls } from "./walls/thickness.js";

export const PROPERTIES = {
  /** Nine numbers a facet, mm, in the file's pose; a new array is a new model. */
  positions: given<Float32Array | null>(null),
  /** Turns the model before it is put on the plate. Ignored while the model is being dragged by its rings. */
  rotation: given<Rotation>(UPRIGHT),
  /** Factor applied to the file's lengths. */
  scale: given(1),
  /** How far the model is above the plate, mm. */
  lift_mm: given(0),
  /** Vertex positions of its supports, nine numbers a facet, mm from the plate; null without supports. */
  supports: given<Float32Array | null>(null),
  /** Vertex positions of the walls of its void, likewise, which the tool `drains` shows; null if it is solid. */
  voids: given<Float32Array | null>(null),
  /** The points that the tools `supports` and `drains` show and place. */
  points: given<readonly ViewPoint[]>([]),
  /** The place of the selected point. */
  point: given<number | null>(null),
  /** Layer boundaries from 0 to the top, mm; empty without a plan. */
  z_mm: given<readonly number[]>([]),
  /** One for each layer. */
  thickness_mm: given<readonly number[]>([]),
  /** Thicknesses at the ends of the colour scale, mm. */
  limits: given<readonly [number, number]>([0, 0]),
  /** The selected layer, counted from 0. */
  layer: given<number | null>(null),
  /** Places that are marked; the first is turned to the viewer. */
  marks: given<readonly Mark[]>([]),
  /** The printer's build volume; without one the plate is a grid that fades out. */
  plate: given<BuildVolume | null>(null),
  /** The copies on the plate, of which the model is the one at `selected`; empty: it is alone in the middle. */
  copies: given<readonly Copy[]>([]),
  /** The place of the selected copy. */
  selected: given<number | null>(null),
  look: given<Look>("thickness"),
  palette: given<PaletteName>("classic"),
  tool: given<Tool>("turn"),
  /**
   * Looks from the front without perspective, so that a height is a row of pixels: see `cusp-frame`. Without effect while there
   * is a plot, but not beside the view.
   */
  aligned: given(false),
  /** The heights shown when aligned; null for the whole model. */
  heights_mm: given<Heights | null>(null),
  /** What the view is aligned with: these heights extend from its lower to its upper edge. Its place is looked up in every frame. */
  plot: given<HTMLElement | null>(null),
  /** Room above and below those heights when aligned without a plot. */
  inset: given<Inset>({ top_px: 12, bottom_px: 12 }),
  /** True if the camera is near the largest stair steps of the side that faces the viewer. Needs a plan. */
  near: given(false),
  /** Painted weight of each facet, 0 to 1; null: all 1. Ignored during a stroke. */
  weights: given<Float32Array | null>(null),
  /** Saliency of each facet, 0 to 1; null: all 1. */
  saliency: given<Float32Array | null>(null),
  /** Which quantity the look `weights` shows. */
  heat: given<Heat>("paint"),
  /** Least value of the product of weight and saliency, when that is shown. */
  least: given(0),
  /** What is thinner than this is marked in the look `walls`, mm. */
  wall_mm: given(0),
  brush: given(BRUSH),
  showsLegend: given(true),
  texts: given(ENGLISH),
  /** Progress of computing the stair steps, 0 to 1; null when idle. */
  building: own<number | null>(null),
  /** Progress of measuring their distances from the model. */
  measuring: own<number | null>(null),
  /** The largest of these distances, mm; null until they are measured. */
  greatest_mm: own<number | null>(null),
  /** Progress of measuring how thick the model is. */
  probing: own<number | null>(null),
  /** How thick the model is, in the file's lengths; null until it is measured. */
  walls: own<Walls | null>(null),
  /** True if the plot is beside the view; null without a plot. */
  isBeside: own<boolean | null>(null),
  /** True if WebGL is missing. */
  broken: own(false),
  /** True if the browser has taken the WebGL context away. */
  lost: own(false),
};
