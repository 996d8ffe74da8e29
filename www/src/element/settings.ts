/** The form's settings: what was typed or chosen, whether it makes sense, and the options it stands for. */
import { METRIC_NAMES, METRICS } from "./metric.js";
import * as round from "./round.js";
import { DEFAULTS, type Metric, type Minimize, type Options, type Snap } from "../api/wire.js";

/** Lengths in mm as typed, so that a half-typed number stays on the screen. */
interface Lengths {
  height: string;
  layerMin: string;
  layerMax: string;
  uniform: string;
  step: string;
}

/** What is chosen from a list. */
interface Choices {
  planner: "optimal" | "uniform";
  metric: Metric;
  minimize: Minimize;
  snap: Snap;
  rays: string;
}

export interface Settings extends Lengths, Choices {
  /** Tolerances as typed, each in the unit of its metric. Where there is none or an empty one, the core's own holds. */
  tolerances: Readonly<Partial<Record<Metric, string>>>;
}

/** What is typed, and may be wrong. */
export type Field = keyof Lengths | "tolerance";

/** What is wrong with a field, in words for the person who typed it. */
export type Faults = Partial<Record<Field, string>>;

/** Rays along the longer side that the form offers, coarse to fine. */
export const RAYS = [512, 1024, 2048, 4096] as const;

export const DEFAULT_SETTINGS: Settings = {
  height: "",
  layerMin: String(DEFAULTS.layer_min_mm),
  layerMax: String(DEFAULTS.layer_max_mm),
  uniform: String(DEFAULTS.layer_min_mm),
  step: "",
  planner: "optimal",
  metric: DEFAULTS.metric,
  minimize: DEFAULTS.minimize,
  snap: DEFAULTS.snap,
  rays: String(DEFAULTS.rays),
  tolerances: {},
};

const LENGTHS: readonly (keyof Lengths)[] = ["height", "layerMin", "layerMax", "uniform", "step"];

const CHOICES: { readonly [Key in keyof Choices]: readonly Choices[Key][] } = {
  planner: ["optimal", "uniform"],
  metric: METRIC_NAMES,
  minimize: ["layers", "time"],
  snap: ["auto", "off"],
  rays: RAYS.map(String),
};

/**
 * The settings with those that a page address names, such as `?height=60&metric=area&tolerance=5`; its other parts are
 * left alone. What it says is judged like anything typed, but a choice that is none is ignored, as there is no field to
 * show it in.
 */
export function fromAddress(query: string): Settings {
  const address = new URLSearchParams(query);
  const settings = { ...DEFAULT_SETTINGS };
  const choose = <Key extends keyof Choices>(key: Key): void => {
    const choice = CHOICES[key].find((choice) => choice === address.get(key));
    if (choice !== undefined) (settings as Choices)[key] = choice;
  };
  for (const key of Object.keys(CHOICES) as (keyof Choices)[]) choose(key);
  for (const key of LENGTHS) settings[key] = address.get(key) ?? settings[key];
  const tolerance = address.get("tolerance");
  return tolerance === null ? settings : { ...settings, ...withTolerance(settings, tolerance) };
}

/** The change of settings that types a tolerance for the metric on show. */
export function withTolerance({ metric, tolerances }: Settings, text: string): Pick<Settings, "tolerances"> {
  return { tolerances: { ...tolerances, [metric]: text } };
}

/** The tolerance that holds where none is typed, in the metric's unit: what the core took by itself, or will take. */
export function usualTolerance(metric: Metric, taken: number | null): string {
  return String(round.up((taken ?? DEFAULTS.tolerance[metric]) * METRICS[metric].scale));
}

export type Checked = { ok: true; options: Options } | { ok: false; faults: Faults };

/** The thickest layer a resin printer could cure; past it a number is a slip of the unit (µm for mm). */
const THICKEST_MM = 1;
const THINNEST_MM = 0.001;
const TALLEST_MM = 1000;

/**
 * Options for the core, or every fault at once. A field that the chosen planner does not use is not judged.
 */
export function check(settings: Settings): Checked {
  const faults: Faults = {};

  const read = (field: Field, text: string, least: number, most: number, unit = "mm"): number => {
    const value = parse(text);
    const range = `${least} to ${most} ${unit}`;
    if (value === null) faults[field] = `Enter a number, ${range}.`;
    else if (value < least || value > most) faults[field] = `Must be ${range}.${unitHint(value, least, most, unit)}`;
    return value ?? Number.NaN;
  };
  const layer = (field: "layerMin" | "layerMax" | "uniform" | "step"): number =>
    read(field, settings[field], THINNEST_MM, THICKEST_MM);

  const { metric, planner } = settings;
  const options: Options = { rays: Number(settings.rays), metric };
  if (settings.height.trim() !== "") options.height_mm = read("height", settings.height, 0.1, TALLEST_MM);

  if (planner === "uniform") {
    options.planner = { kind: planner, layer_mm: layer("uniform") };
  } else {
    options.planner = { kind: planner };
    options.minimize = settings.minimize;
    options.snap = settings.snap;
    if (hasStep(settings)) options.step_mm = layer("step");
  }
  // The range also sets the two uniform plans that the result is compared with, so it counts for either planner.
  const min = (options.layer_min_mm = layer("layerMin"));
  const max = (options.layer_max_mm = layer("layerMax"));
  if (min > max) faults.layerMax = "The thickest layer must not be thinner than the thinnest.";

  const typed = settings.tolerances[metric] ?? "";
  if (typed.trim() !== "") {
    const { tolerances, unit, scale } = METRICS[metric];
    options.tolerance = read("tolerance", typed, ...tolerances, unit) / scale;
  }

  const bin_mm = binOf(settings);
  if (bin_mm !== DEFAULTS.bin_mm) options.bin_mm = bin_mm;
  if (!hasStep(settings)) {
    for (const field of thicknesses(settings)) {
      if (!isMultiple(parse(settings[field]) ?? 0, bin_mm)) faults[field] ??= "Use steps of 0.001 mm.";
    }
  }

  return Object.keys(faults).length === 0 ? { ok: true, options } : { ok: false, faults };
}

/** Whether heights are to be whole motor steps. Uniform layers are as thick as they are said to be. */
const hasStep = ({ planner, step }: Settings): boolean => planner === "optimal" && step.trim() !== "";

/** The thicknesses that must be whole bins where there is no motor step. */
const thicknesses = ({ planner }: Settings): ("layerMin" | "layerMax" | "uniform")[] =>
  planner === "uniform" ? ["layerMin", "layerMax", "uniform"] : ["layerMin", "layerMax"];

/**
 * The bin to plan in, in mm: the usual one; half of it where a thickness needs that; with a motor step the largest one,
 * up to the usual, that divides it.
 */
export function binOf(settings: Settings): number {
  if (hasStep(settings)) {
    const step = parse(settings.step) ?? 0;
    return step < THINNEST_MM ? DEFAULTS.bin_mm : step / Math.ceil(step / DEFAULTS.bin_mm - ROUNDING);
  }
  const isWhole = thicknesses(settings).every((field) => isMultiple(parse(settings[field]) ?? 0, DEFAULTS.bin_mm));
  return isWhole ? DEFAULTS.bin_mm : DEFAULTS.bin_mm / 2;
}

/** Thinnest and thickest layer of a plan in mm: whole motor steps, where there is one. */
export function layerRange({ layer_min_mm = 0, layer_max_mm = 0, step_mm }: Options): [number, number] {
  if (step_mm === undefined) return [layer_min_mm, layer_max_mm];
  const [least, most] = [Math.ceil(layer_min_mm / step_mm - ROUNDING), Math.floor(layer_max_mm / step_mm + ROUNDING)];
  return [least * step_mm, most * step_mm];
}

/** A number as people type it, with a point or a comma; null if it is none. */
export function parse(text: string): number | null {
  const tidy = text.trim().replace(",", ".");
  if (!/^\d*\.?\d+$|^\d+\.$/.test(tidy)) return null;
  return Number(tidy);
}

/** What a quotient of decimals may be off by. */
const ROUNDING = 1e-6;

function isMultiple(value: number, step: number): boolean {
  const times = value / step;
  return Math.abs(times - Math.round(times)) < ROUNDING;
}

function unitHint(value: number, least: number, most: number, unit: string): string {
  const asMicrometres = value / 1000;
  const isSlip = unit === "mm" && value > most && asMicrometres >= least && most < TALLEST_MM;
  return isSlip ? ` ${value} µm is ${asMicrometres} mm.` : "";
}

/**
 * Whether two sets of options look at the model through the same rays: then going from one to the other is a matter of
 * milliseconds and not worth interrupting.
 */
export function sameRays(a: Options, b: Options): boolean {
  return (
    a.height_mm === b.height_mm &&
    a.rays === b.rays &&
    a.pitch_mm === b.pitch_mm &&
    a.backend === b.backend &&
    String(a.pixels) === String(b.pixels)
  );
}
