/** The measures of error: their units, and how their values are written. Their names are in the catalogues. */
import type { Metric } from "../../api/wire.js";
import type { Format } from "../../texts/index.js";

export interface Measure {
  /** What tolerances are typed in. */
  unit: string;
  /** How many of that unit the core's own unit is. */
  scale: number;
  /** Least and greatest tolerance that makes sense, in that unit: none is above what layers of 1 mm can come to. */
  tolerances: readonly [number, number];
  /** An error or a tolerance with its unit. */
  error(value: number, format: Format): string;
  /** A value of the profile as a number on its axis. */
  tick(value: number, format: Format): string;
  /** A value of the profile with its unit. */
  density(value: number, format: Format): string;
  /** The greatest value that a profile can have; null where that depends on the model. */
  bound: number | null;
}

const plainTick = (value: number, format: Format): string => format.tick(value);
const errorOf =
  (metric: Metric) =>
  (value: number, format: Format): string =>
    format.error(metric, value);
const length = {
  unit: "mm",
  scale: 1,
  tick: plainTick,
  density: plainTick,
};

export const METRICS: Readonly<Record<Metric, Measure>> = {
  cusp: { ...length, error: errorOf("cusp"), tolerances: [0.001, 1], bound: 1 },
  roughness: { ...length, error: errorOf("roughness"), tolerances: [0.001, 2], bound: 2 },
  area: {
    unit: "%",
    scale: 100,
    tolerances: [0.1, 200],
    error: errorOf("area"),
    tick: (value, format) => format.percent(value),
    density: (value, format) => format.percent(value, 1),
    bound: 2,
  },
  volume: {
    unit: "mm³",
    scale: 1,
    tolerances: [0.001, 1_000_000],
    error: errorOf("volume"),
    tick: plainTick,
    density: (value, format) => format.area(value),
    bound: null,
  },
};

export const METRIC_NAMES = Object.keys(METRICS) as Metric[];
