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
  /** Smallest and largest valid tolerance, in that unit. */
  tolerances: readonly [number, number];
  /** Formats an error or a tolerance with its unit. */
  error(value: number, format: Format): string;
  /** Formats a value of the profile for its axis, without unit. */
  tick(value: number, format: Format): string;
  /** Greatest possible value of a profile; null if it depends on the model. */
  bound: number | null;
}

type Shown = Pick<Measure, "unit" | "scale" | "tick">;

const plain = (value: number, format: Format): string => format.tick(value);

const LENGTH: Shown = { unit: "mm", scale: 1, tick: plain };

/** Metrics whose errors are no lengths. */
const OTHERS: Partial<Record<Metric, Partial<Shown>>> = {
  area: {
    unit: "%",
    scale: 100,
    tick: (value, format) => format.percent(value),
  },
  volume: { unit: "mm³" },
};

const measures = FACTS.metrics.map(({ name, tolerances: [least, most], greatest_density: bound = null }): [Metric, Measure] => {
  const shown = { ...LENGTH, ...OTHERS[name] };
  const { scale } = shown;
  return [name, { ...shown, tolerances: [least * scale, most * scale], bound, error: (value, format) => format.error(name, value) }];
});

export const METRICS = Object.fromEntries(measures) as Readonly<Record<Metric, Measure>>;

/** The current name of a metric, given that or its name in earlier versions. */
export const currentName = (name: string): string => (name === "thread" ? "filament-roundness" : name);

export const METRIC_NAMES: readonly Metric[] = FACTS.metrics.map(({ name }) => name);
