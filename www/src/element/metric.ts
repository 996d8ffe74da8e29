/** The measures of error: their names, their units, and what is said of their profiles. */
import * as format from "../texts/format.js";
import type { Metric } from "../api/wire.js";

export interface Measure {
  name: string;
  /** One sentence for people who do not know it. */
  help: string;
  /** What tolerances are typed in. */
  unit: string;
  /** How many of that unit the core's own unit is. */
  scale: number;
  /** Least and greatest tolerance that makes sense, in that unit: none is above what layers of 1 mm can come to. */
  tolerances: readonly [number, number];
  /** An error or a tolerance with its unit. */
  error(value: number): string;
  /** What the profile's axis says. */
  axis: string;
  /** A value of the profile as a number on that axis. */
  tick(value: number): string;
  /** A value of the profile in words. */
  density(value: number): string;
  /** The greatest value that a profile can have; null where that depends on the model. */
  bound: number | null;
}

export const METRICS: Readonly<Record<Metric, Measure>> = {
  cusp: {
    name: "Cusp height",
    help: "The largest step that a layer may leave on the surface.",
    unit: "mm",
    scale: 1,
    tolerances: [0.001, 1],
    error: format.fine,
    axis: "Error density: 0 upright, 1 level",
    tick: format.tick,
    density: (value) => `error density ${format.tick(value)}`,
    bound: 1,
  },
  roughness: {
    name: "Surface roughness",
    help: "How rough the surface may come out (Ra); even upright walls show their layers.",
    unit: "mm",
    scale: 1,
    tolerances: [0.001, 2],
    error: format.fine,
    axis: "Roughness density: 1 upright, 2 near level",
    tick: format.tick,
    density: (value) => `roughness density ${format.tick(value)}`,
    bound: 2,
  },
  area: {
    name: "Area deviation",
    help: "How much the cross-section may grow or shrink within a layer.",
    unit: "%",
    scale: 100,
    tolerances: [0.1, 200],
    error: (value) => format.percent(value, 2),
    axis: "Change of section per mm",
    tick: format.percent,
    density: (value) => `the section changes by ${format.percent(value, 1)} per mm`,
    bound: 2,
  },
  volume: {
    name: "Volume deviation",
    help: "How much material a layer may have too much or too little.",
    unit: "mm³",
    scale: 1,
    tolerances: [0.001, 1_000_000],
    error: format.volume,
    axis: "Area of the section (mm²)",
    tick: format.tick,
    density: (value) => `a section of ${format.area(value)}`,
    bound: null,
  },
};

export const METRIC_NAMES = Object.keys(METRICS) as Metric[];
