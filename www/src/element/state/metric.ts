/** Metrics: their units, and formatting of their values. Their names are among the texts. */
import { FACTS } from "../../api/facts.js";
import type { Metric } from "../../api/wire.js";
import type { Format } from "../../texts/index.js";
import type { FieldUnit } from "./typed.js";

export interface Measure {
  /** Unit in which tolerances are typed. */
  unit: FieldUnit;
  /** Factor from the core's unit to that unit. */
  scale: number;
  /** Smallest and largest valid tolerance, in that unit; the largest is at most the error of layers of 1 mm. */
  tolerances: readonly [number, number];
  /** Formats an error or a tolerance with its unit. */
  error(value: number, format: Format): string;
  /** Formats a value of the profile for its axis, without unit. */
  tick(value: number, format: Format): string;
  /** Formats a value of the profile with its unit. */
  density(value: number, format: Format): string;
  /** Greatest possible value of a profile; null if it depends on the model. */
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
} as const;

export const METRICS: Readonly<Record<Metric, Measure>> = {
  cusp: { ...length, error: errorOf("cusp"), tolerances: [0.001, 1], bound: 1 },
  deviation: { ...length, error: errorOf("deviation"), tolerances: [0.0005, 0.5], bound: 1 },
  "filament-roundness": { ...length, error: errorOf("filament-roundness"), tolerances: [0.001, 1], bound: 1 },
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

/** The current name of a metric, given that or its name in earlier versions. */
export const currentName = (name: string): string => (name === "thread" ? "filament-roundness" : name);

export const METRIC_NAMES: readonly Metric[] = FACTS.metrics.map(({ name }) => name);
