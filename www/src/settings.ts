/** The form's settings: what was typed, whether it makes sense, and the options it stands for. */
import { DEFAULTS, type Options } from "./wire.js";

/** Every field as typed, so that a half-typed number stays on the screen. */
export interface Settings {
  height: string;
  layerMin: string;
  layerMax: string;
  tolerance: string;
  rays: string;
  planner: "optimal" | "uniform";
  uniform: string;
}

export type Field = keyof Settings;

/** What is wrong with a field, in words for the person who typed it. */
export type Faults = Partial<Record<Field, string>>;

export const DEFAULT_SETTINGS: Settings = {
  height: "",
  layerMin: String(DEFAULTS.layer_min_mm),
  layerMax: String(DEFAULTS.layer_max_mm),
  tolerance: String(DEFAULTS.tolerance_mm),
  rays: String(DEFAULTS.rays),
  planner: "optimal",
  uniform: String(DEFAULTS.layer_min_mm),
};

/**
 * The settings with those that a page address names, such as `?height=60&rays=4096`; its other parts are left alone.
 * What it says is judged like anything typed, but a planner that is none is ignored, as there is no field to show it in.
 */
export function fromAddress(query: string): Settings {
  const settings = { ...DEFAULT_SETTINGS };
  for (const [key, value] of new URLSearchParams(query)) {
    if (key === "planner") {
      if (value === "optimal" || value === "uniform") settings.planner = value;
    } else if (key === "rays") {
      if (RAYS.some((rays) => String(rays) === value)) settings.rays = value;
    } else if (Object.hasOwn(settings, key)) {
      settings[key as Exclude<Field, "planner" | "rays">] = value;
    }
  }
  return settings;
}

/** Rays along the longer side that the form offers, coarse to fine. */
export const RAYS = [512, 1024, 2048, 4096] as const;

export type Checked = { ok: true; options: Options } | { ok: false; faults: Faults };

/** The thickest layer a resin printer could cure; past it a number is a slip of the unit (µm for mm). */
const THICKEST_MM = 1;
const TALLEST_MM = 1000;

/**
 * Options for the core, or every fault at once. A field that the chosen planner does not use is not judged.
 */
export function check(settings: Settings): Checked {
  const faults: Faults = {};

  const read = (field: Field, least: number, most: number): number => {
    const value = parse(settings[field]);
    const range = `${least} to ${most} mm`;
    if (value === null) faults[field] = `Enter a number, ${range}.`;
    else if (value < least || value > most) faults[field] = `Must be ${range}.${unitHint(value, least, most)}`;
    return value ?? Number.NaN;
  };

  const options: Options = { rays: Number(settings.rays) };
  if (settings.height.trim() !== "") options.height_mm = read("height", 0.1, TALLEST_MM);

  if (settings.planner === "uniform") {
    const layer = read("uniform", DEFAULTS.bin_mm, THICKEST_MM);
    options.planner = { kind: "uniform", layer_mm: layer };
  } else {
    options.planner = { kind: "optimal" };
  }
  // The range also sets the two uniform plans that the result is compared with, so it counts for either planner.
  const min = (options.layer_min_mm = read("layerMin", DEFAULTS.bin_mm, THICKEST_MM));
  const max = (options.layer_max_mm = read("layerMax", DEFAULTS.bin_mm, THICKEST_MM));
  if (min > max) faults.layerMax = "The thickest layer must not be thinner than the thinnest.";
  options.tolerance_mm = read("tolerance", 0.001, THICKEST_MM);

  // Layers are made of whole bins: halve the usual bin where a thickness needs it.
  const thicknesses: Field[] = settings.planner === "uniform" ? ["layerMin", "layerMax", "uniform"] : ["layerMin", "layerMax"];
  for (const field of thicknesses) {
    const value = parse(settings[field]) ?? 0;
    if (isMultiple(value, DEFAULTS.bin_mm)) continue;
    if (isMultiple(value, DEFAULTS.bin_mm / 2)) options.bin_mm = DEFAULTS.bin_mm / 2;
    else faults[field] ??= "Use steps of 0.001 mm.";
  }

  return Object.keys(faults).length === 0 ? { ok: true, options } : { ok: false, faults };
}

/** A number as people type it, with a point or a comma; null if it is none. */
export function parse(text: string): number | null {
  const tidy = text.trim().replace(",", ".");
  if (!/^\d*\.?\d+$|^\d+\.$/.test(tidy)) return null;
  return Number(tidy);
}

function isMultiple(value: number, step: number): boolean {
  const times = value / step;
  return Math.abs(times - Math.round(times)) < 1e-6;
}

function unitHint(value: number, least: number, most: number): string {
  const asMicrometres = value / 1000;
  return value > most && asMicrometres >= least && most <= THICKEST_MM ? ` ${value} µm is ${asMicrometres} mm.` : "";
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
