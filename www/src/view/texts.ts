/** All texts of the view. They format their own numbers, since the view itself has no language. */

import type { Tool } from "./scene/keys.js";

export interface ViewTexts {
  /** Name of the view for screen readers. */
  readonly name: string;
  /** Role of the view for screen readers. */
  readonly kind: string;
  /** Keyboard help for each tool. */
  readonly keys: Readonly<Record<Tool, string>>;
  /** Describes the model shown. */
  readonly state: (size_mm: readonly [number, number, number], layers: number) => string;
  /** Replaces `state` when no model is shown. */
  readonly empty: string;
  /** Heading of the colour scale, with its unit. */
  readonly legend: string;
  /** Heading of the colour scale of weights, which runs from 0 to 1. */
  readonly heat: string;
  /** Heading of the colour scale of distances from the model, with its unit. */
  readonly distance: string;
  /** Heading of the colour scale of wall thickness, with its unit. */
  readonly walls: string;
  /** Label of the mark for walls thinner than the limit. */
  readonly thin: (least_mm: number) => string;
  /** A wall thickness on the colour scale, in millimetres without the unit. */
  readonly wall: (thickness_mm: number) => string;
  /** Progress of measuring the walls. */
  readonly probing: (progress: number) => string;
  /** A weight on the colour scale. */
  readonly weight: (weight: number) => string;
  /** A thickness or distance on the colour scale, without its unit. */
  readonly tick: (length_mm: number) => string;
  /** Describes the selected layer, counted from 0. */
  readonly layer: (layer: number, z_mm: number, thickness_mm: number) => string;
  /** Spacing of the plate's grid. */
  readonly grid: (step_mm: number) => string;
  /** Progress of computing the stair steps, 0 to 1. */
  readonly building: (progress: number) => string;
  /** Progress of measuring their distances from the model. */
  readonly measuring: (progress: number) => string;
  /** Message in place of the view if the browser has no WebGL. */
  readonly unavailable: string;
  /** Message while the WebGL context is lost, with the name of the button that requests another. */
  readonly lost: string;
  readonly again: string;
}

const MICROMETRES = 1000;

const english = (digits: number): ((value: number) => string) => {
  const format = new Intl.NumberFormat("en", { maximumFractionDigits: digits });
  return (value) => format.format(value);
};

/** From this thickness on, tenths of a µm are omitted. */
const WHOLE_FROM_UM = 100;

const whole = english(0);
const tenths = english(1);
const hundredths = english(2);
const micrometres = (mm: number): string => {
  const um = mm * MICROMETRES;
  return (um < WHOLE_FROM_UM ? tenths : whole)(um);
};
const exact = new Intl.NumberFormat("en", { maximumSignificantDigits: 1 });

/** The English sentences without numbers. */
export const ENGLISH_SENTENCES: Pick<ViewTexts, "kind" | "keys" | "empty" | "legend" | "heat" | "distance" | "walls" | "unavailable" | "lost" | "again"> = {
  kind: "3-D view",
  keys: {
    turn: "Arrow keys turn the view, plus and minus zoom, 0 shows the whole model.",
    move: "Arrow keys move the selected copies by 1 mm, with Shift by 10 mm; R turns them by 15°, with Shift by 45°.",
    rotate: "Arrow keys and Page Up and Page Down turn the model by 5°, with Shift by 1°.",
    size: "Arrow keys scale the model by 1 %, with Shift by 10 %.",
    flat: "Enter lays the face in the middle of the view on the plate. Arrow keys turn the view.",
    paint: "Enter paints in the middle of the view, Ctrl+Z takes it back. Arrow keys turn the view.",
    supports: "Enter adds a point in the middle of the view. Arrow keys go from point to point, Delete removes one, L locks it. Arrow keys with Shift turn the view.",
    drains: "Enter adds a hole in the middle of the view. Arrow keys go from hole to hole, Delete removes one, L locks it. Arrow keys with Shift turn the view.",
  },
  empty: "No model yet",
  legend: "Layer thickness (µm)",
  heat: "How much it matters",
  distance: "Distance from the model (µm)",
  walls: "Wall thickness (mm)",
  unavailable: "This browser shows no 3-D view: WebGL 2 is switched off or missing.",
  lost: "The browser has stopped the 3-D view. The model and its plan are still there.",
  again: "Show again",
};

export const ENGLISH: ViewTexts = {
  ...ENGLISH_SENTENCES,
  name: "Model",
  state: ([x, y, z], layers) =>
    `${tenths(x)} × ${tenths(y)} × ${tenths(z)} mm` + (layers > 0 ? `, ${whole(layers)} layers` : ""),
  weight: (weight) => `${whole(100 * weight)}%`,
  tick: micrometres,
  thin: (least_mm) => `Thinner than ${hundredths(least_mm)} mm`,
  wall: hundredths,
  probing: (progress) => `Measuring the walls: ${whole(100 * progress)} %`,
  layer: (layer, z_mm, thickness_mm) =>
    `Layer ${whole(layer + 1)} · ${hundredths(z_mm)} mm · ${micrometres(thickness_mm)} µm`,
  grid: (step_mm) => `Grid ${exact.format(step_mm)} mm`,
  building: (progress) => `Working out the steps: ${whole(100 * progress)} %`,
  measuring: (progress) => `Measuring the distances: ${whole(100 * progress)} %`,
};
