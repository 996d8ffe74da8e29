/** The form's settings: what was typed or chosen, whether it is valid, and the options that it gives. */
import { FACTS, FORMATS, isFilament, nozzleLayers, usualOf } from "../../api/facts.js";
import type { Format as FileFormat, KnownPrinter, Metric, Minimize, ModelUnit, Options, Resin, Snap, SupportStrength } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { currentName, METRIC_NAMES, METRICS } from "./metric.js";
import { NO_POINTS, placedFrom, placedText } from "./placed.js";
import { ADDRESS_CHARS, printerFrom, printerOf, printerText, type ChosenPrinter } from "./printer.js";
import * as round from "./round.js";
import { profileOf, type Sizes } from "./support-sizes.js";
import { canonical, read, UNITS_SHOWN, type FieldUnit, type Misread } from "./typed.js";

/** Lengths in mm: canonical numbers, or invalid text as typed. */
interface Lengths {
  height: string;
  layerMin: string;
  layerMax: string;
  uniform: string;
  step: string;
  /** Wall thickness of a hollow model; empty for a solid one. */
  wall: string;
  /** Nozzle diameter of a filament printer; empty for the usual one. */
  nozzle: string;
  /** Maximum layer thickness below the model; empty for that of all layers. */
  supportLayer: string;
}

/** Exposures in s, a count, depths in mm and a fraction, likewise; empty for the resin's own. */
interface Curing {
  exposure: string;
  bottomExposure: string;
  bottomLayers: string;
  penetration: string;
  /** If given, masks and planes make up for print-through. */
  overcure: string;
  retained: string;
}

/** Settings chosen from a list. */
interface Choices {
  planner: "optimal" | "uniform";
  metric: Metric;
  minimize: Minimize;
  snap: Snap;
  rays: string;
  /** If on, salient facets weigh more. */
  saliency: "off" | "on";
  /** Strength of supports. */
  supports: "none" | SupportStrength;
  /** If allowed, print files of supported models are written although pieces float in the vat. */
  floating: "refuse" | "allow";
  /** If on, all supports stand on one raft. */
  raft: "off" | "on";
  /** If on, automatic supports are added to those by hand. */
  fill: "off" | "on";
  /** If on, automatic supports and drain holes avoid areas painted as important. */
  protect: "off" | "on";
  /** Infill of a hollow model's void. */
  infill: "none" | "lattice";
  /** If auto, a hollow model gets drain holes automatically. */
  drain: "auto" | "none";
  /** Minimum weight of a facet. */
  weightMin: string;
  /** Empty for the printer's own format. */
  format: FileFormat | "";
  /** Unit of a file that states none; empty for millimetres. */
  unit: ModelUnit | "";
}

/** Free-form settings; empty for none. */
interface Names {
  printer: ChosenPrinter;
  /** Name of one of the host's resins. */
  resin: string;
  /** Rotation from the file to the pose: x, y, z and w of a unit quaternion, separated by commas. */
  rotation: string;
  /** Support points and drain holes placed by hand: see `placed.ts`. */
  points: string;
  drains: string;
}

export interface Settings extends Lengths, Sizes, Curing, Choices, Names {
  /** Tolerances, likewise, each in the unit of its metric; if absent or empty, the core's default. */
  tolerances: Readonly<Partial<Record<Metric, string>>>;
}

/** A text field, which may be invalid. */
export type Field = keyof Lengths | keyof Sizes | keyof Curing | "tolerance";

/** Fault of a field. */
export type Fault =
  | { kind: Misread | "range"; value: number | null; least: number; most: number; unit: FieldUnit }
  | { kind: "upsideDown" | "whole" };

export type Faults = Partial<Record<Field, Fault>>;

/** The printers and resins to choose from. */
export interface Offered {
  printers: readonly KnownPrinter[];
  /** Names of printers chosen before, the last first. */
  recent?: readonly string[];
  resins: readonly Resin[];
}

/** Numbers of rays along the longer side offered by the form, coarse to fine. */
export const RAYS = [512, 1024, 2048, 4096] as const;

/** Minimum weights offered by the form. 0 is excluded: it would allow any layer on a facet. */
export const WEIGHT_STEPS: readonly string[] = Array.from({ length: 20 }, (_, i) => String((5 * i + 5) / 100));

const { defaults: DEFAULTS, usual: USUAL } = FACTS;

export const DEFAULT_SETTINGS: Settings = {
  height: "",
  layerMin: String(DEFAULTS.layer_min_mm),
  layerMax: String(DEFAULTS.layer_max_mm),
  uniform: String(DEFAULTS.layer_min_mm),
  step: "",
  wall: "",
  nozzle: "",
  supportLayer: "",
  lift: "",
  supportSpacing: "",
  contact: "",
  pillar: "",
  supportAngle: "",
  raftThickness: "",
  raftMargin: "",
  planner: "optimal",
  metric: DEFAULTS.metric,
  minimize: DEFAULTS.minimize,
  snap: DEFAULTS.snap,
  rays: String(DEFAULTS.rays),
  saliency: DEFAULTS.saliency ? "on" : "off",
  supports: "none",
  floating: "refuse",
  raft: "off",
  fill: "off",
  protect: "off",
  infill: "none",
  drain: "auto",
  weightMin: String(DEFAULTS.weight_min),
  format: "",
  unit: "",
  printer: "",
  resin: "",
  rotation: "",
  points: "",
  drains: "",
  exposure: "",
  bottomExposure: "",
  bottomLayers: "",
  penetration: "",
  overcure: "",
  retained: "",
  tolerances: {},
};

/** Defaults of a format: filament formats have other layer limits, which depend on the nozzle. */
export function defaultsOf(format: FileFormat | "", nozzle = ""): Settings {
  const layers = nozzleLayers(format, nozzleOf(nozzle));
  if (layers === null) return { ...DEFAULT_SETTINGS, format, nozzle };
  const { layer_min_mm, layer_max_mm, first_layer_mm } = layers;
  const limits = { layerMin: String(layer_min_mm), layerMax: String(layer_max_mm), uniform: String(first_layer_mm) };
  return { ...DEFAULT_SETTINGS, format, nozzle, ...limits };
}

/** Nozzle diameter as typed; the usual one if invalid. */
export function nozzleOf(nozzle: string): number {
  const typed = parse(nozzle) ?? Number.NaN;
  const [least, most] = USUAL.nozzle_mm;
  return typed >= least && typed <= most ? typed : FACTS.nozzle_mm;
}

/** Change of limits that goes with a change of format or nozzle: limits at their defaults follow the new defaults. */
export function limitsFor(settings: Settings, format: FileFormat | "", nozzle = settings.nozzle): Partial<Settings> {
  const [before, after] = [defaultsOf(settings.format, settings.nozzle), defaultsOf(format, nozzle)];
  const change: Partial<Settings> = {};
  for (const key of ["layerMin", "layerMax", "uniform"] as const) if (settings[key] === before[key]) change[key] = after[key];
  return change;
}

/** Settings after a change. Points by hand belong to a pose, so a new pose clears them. */
export function changed(settings: Settings, change: Partial<Settings>): Settings {
  const isSame = (["rotation", "height", "unit"] as const).every((key) => change[key] === undefined || change[key] === settings[key]);
  return { ...settings, ...(isSame ? {} : withoutPlaced(settings)), ...change };
}

/** Change of settings that makes all points automatic, if some are placed by hand. */
export function withoutPlaced({ points, drains }: Settings): Partial<Settings> {
  return { ...(points !== "" && { points: "", fill: "off" }), ...(drains !== "" && { drains: "", drain: "auto" }) };
}

/** Change of settings that chooses a nozzle. */
export function withNozzle(settings: Settings, nozzle: string): Partial<Settings> {
  return { ...limitsFor(settings, settings.format, nozzle), nozzle };
}

/** Change of settings that chooses a format. For filament formats, it clears resin-only settings. */
export function withFormat(settings: Settings, format: FileFormat | ""): Partial<Settings> {
  const change = { ...limitsFor(settings, format), format };
  return isFilament(format) ? { ...change, printer: "", minimize: DEFAULT_SETTINGS.minimize } : change;
}

/** Change of settings that chooses a printer and resets the format to its own. */
export function withPrinter(settings: Settings, printer: ChosenPrinter): Partial<Settings> {
  return printer !== "" && isFilament(settings.format) ? { ...withFormat(settings, ""), printer } : { printer };
}

/** Units of the typed numbers, in the order of a URL. */
const UNITS: Readonly<Record<keyof Lengths | keyof Sizes | keyof Curing, FieldUnit>> = {
  height: "mm",
  layerMin: "mm",
  layerMax: "mm",
  uniform: "mm",
  step: "mm",
  wall: "mm",
  nozzle: "mm",
  supportLayer: "mm",
  lift: "mm",
  supportSpacing: "mm",
  contact: "mm",
  pillar: "mm",
  supportAngle: "°",
  raftThickness: "mm",
  raftMargin: "mm",
  exposure: "s",
  bottomExposure: "s",
  bottomLayers: "",
  penetration: "mm",
  overcure: "mm",
  retained: "",
};

const NUMBERS = Object.keys(UNITS) as (keyof typeof UNITS)[];

/** Unit of a field, for display and for input without a unit. */
export function unitOf(field: Field, metric: Metric): FieldUnit {
  return field === "tolerance" ? METRICS[metric].unit : UNITS[field];
}

const NAMES: readonly (keyof Names)[] = ["printer", "resin", "rotation", "points", "drains"];

const CHOICES: { readonly [Key in keyof Choices]: readonly Choices[Key][] } = {
  planner: ["optimal", "uniform"],
  metric: METRIC_NAMES,
  minimize: ["layers", "time"],
  snap: ["auto", "off"],
  rays: RAYS.map(String),
  saliency: ["off", "on"],
  supports: ["none", "light", "medium", "heavy"],
  floating: ["refuse", "allow"],
  raft: ["off", "on"],
  fill: ["off", "on"],
  protect: ["off", "on"],
  infill: ["none", "lattice"],
  drain: ["auto", "none"],
  weightMin: WEIGHT_STEPS,
  format: ["", ...FORMATS],
  unit: ["", "micron", "millimeter", "centimeter", "inch", "foot", "meter"],
};

/** An address with names of earlier versions replaced by the current ones. */
function current(address: URLSearchParams): URLSearchParams {
  const [metric, protect] = [address.get("metric"), address.get("spare")];
  if (metric !== null) address.set("metric", currentName(metric));
  if (protect !== null) address.set("protect", protect);
  return address;
}

/**
 * Settings from a URL query such as `?height=60&metric=area&tolerance=5`, based on the defaults; other parameters are ignored. Numbers are
 * checked later, like typed ones, and may have a decimal comma and a unit. An unknown choice is ignored, as no field could show it.
 */
export function fromAddress(query: string): Settings {
  const address = current(new URLSearchParams(query));
  const asked = address.get("format");
  const nozzle = canonical(address.get("nozzle") ?? "", UNITS.nozzle);
  const settings = { ...defaultsOf(CHOICES.format.find((format) => format === asked) ?? "", nozzle) };
  const choose = <Key extends keyof Choices>(key: Key): void => {
    const choice = CHOICES[key].find((choice) => choice === address.get(key));
    if (choice !== undefined) (settings as Choices)[key] = choice;
  };
  for (const key of Object.keys(CHOICES) as (keyof Choices)[]) choose(key);
  for (const key of NUMBERS) {
    const text = address.get(key);
    if (text !== null) settings[key] = canonical(text, UNITS[key]);
  }
  for (const key of NAMES) {
    const text = address.get(key);
    if (text === null) continue;
    if (key === "printer") settings.printer = printerFrom(text);
    else if (key === "points" || key === "drains") settings[key] = text === NO_POINTS ? text : placedText(placedFrom(text, key) ?? []);
    else settings[key] = text;
  }
  const tolerance = address.get("tolerance");
  if (tolerance === null) return settings;
  return { ...settings, ...withTolerance(settings, canonical(tolerance, unitOf("tolerance", settings.metric))) };
}

/**
 * URL query from which {@link fromAddress} restores the settings: differences from the defaults, in a fixed order. A printer description
 * and points of more than `chars` characters are omitted.
 */
export function toAddress(settings: Settings, chars = ADDRESS_CHARS): string {
  const address = new URLSearchParams();
  const { format, nozzle } = DEFAULT_SETTINGS;
  const usual: Settings = { ...defaultsOf(settings.format, settings.nozzle), format, nozzle };
  for (const key of [...(Object.keys(CHOICES) as (keyof Choices)[]), ...NUMBERS, ...NAMES]) {
    const text = key === "printer" ? printerText(settings.printer, chars) : settings[key];
    const isTooLong = (key === "points" || key === "drains") && text.length > chars;
    if (text !== usual[key] && !isTooLong) address.set(key, text);
  }
  const tolerance = settings.tolerances[settings.metric];
  if (tolerance !== undefined) address.set("tolerance", tolerance);
  return address.toString();
}

/** Change of settings that sets the tolerance of the current metric. */
export function withTolerance({ metric, tolerances }: Settings, text: string): Pick<Settings, "tolerances"> {
  return { tolerances: { ...tolerances, [metric]: text } };
}

/** Default tolerance in the form's unit: the one that the core chose, or will choose. */
export function usualTolerance(metric: Metric, taken: number | null, format: FileFormat | "" = "", nozzle = ""): string {
  const usual = usualOf(metric, format, nozzleOf(nozzle));
  const { scale } = METRICS[metric];
  // The default has few enough digits.
  return String(taken === null || taken === usual ? Number((usual * scale).toFixed(6)) : round.up(taken * scale));
}

export type Checked = { ok: true; options: Options } | { ok: false; faults: Faults };

const NONE: Offered = { printers: [], resins: [] };

/** Options for the core, or all faults at once. Fields that the chosen planner does not use are not checked. */
export function check(settings: Settings, { printers, resins }: Offered = NONE): Checked {
  const faults: Faults = {};

  const { metric, planner } = settings;
  const within = (field: Field, text: string, [least, most]: readonly [number, number]): number => {
    const unit = unitOf(field, metric);
    const { value, fault } = read(text, unit);
    if (value === null) faults[field] = { kind: fault, value, least, most, unit };
    else if (value < least || value > most) faults[field] = { kind: "range", value, least, most, unit };
    return value ?? Number.NaN;
  };

  const options: Options = { metric };
  if (settings.saliency === "on") options.saliency = true;
  if (settings.weightMin !== DEFAULT_SETTINGS.weightMin) options.weight_min = Number(settings.weightMin);
  const printer = printerOf(settings.printer, printers);
  // The core checks an unknown name or a wrong description.
  if (settings.printer === "") options.rays = Number(settings.rays);
  else options.printer = settings.printer;
  if (settings.format !== "") options.format = settings.format;
  if (isFilament(settings.format) && settings.nozzle.trim() !== "") {
    options.nozzle_mm = within("nozzle", settings.nozzle, USUAL.nozzle_mm);
  }
  if (settings.unit !== "") options.unit = settings.unit;
  const layers_mm = printer?.layer_mm ?? USUAL.layer_mm;
  const layer = (field: "layerMin" | "layerMax" | "uniform" | "supportLayer"): number =>
    within(field, settings[field], layers_mm);
  if (settings.height.trim() !== "") options.height_mm = within("height", settings.height, USUAL.height_mm);

  const isProtecting = settings.protect === "on";
  // Slicers for filament printers add supports and hollow by themselves.
  const strength = isFilament(settings.format) ? "none" : settings.supports;
  const profile = strength === "none" ? null : profileOf(settings, strength, within);
  if (strength !== "none" && settings.points !== NO_POINTS) {
    options.supports = { strength, ...(profile !== null && { profile }) };
    const points = placedFrom(settings.points, "points") ?? [];
    if (points.length > 0) {
      options.supports.points = points.map(({ at_mm, diameter_mm }) => ({ at_mm: [...at_mm], ...(diameter_mm !== null && { contact_mm: diameter_mm }) }));
      if (settings.fill === "on") options.supports.fill = true;
    }
    if (isProtecting) options.supports.protect = true;
  }
  if (settings.wall.trim() !== "" && !isFilament(settings.format)) {
    options.hollow = { wall_mm: within("wall", settings.wall, USUAL.wall_mm) };
    if (settings.infill === "lattice") options.hollow.infill = {};
    const drains = placedFrom(settings.drains, "drains") ?? [];
    if (drains.length > 0) {
      options.hollow.drains = drains.flatMap(({ at_mm, inward, diameter_mm }) =>
        inward === null || diameter_mm === null ? [] : [{ at_mm: [...at_mm], direction: [...inward], diameter_mm }],
      );
    }
    if (settings.drain === "auto") options.hollow.auto_drain = isProtecting ? { protect: true } : {};
  }

  if (planner === "uniform") {
    options.planner = { kind: planner, layer_mm: layer("uniform") };
  } else {
    options.planner = { kind: planner };
    options.minimize = settings.minimize;
    options.snap = settings.snap;
    if (planner === "optimal" && settings.step.trim() !== "") options.step_mm = within("step", settings.step, USUAL.step_mm);
  }
  // Both planners need the range, which also defines the two uniform plans for comparison.
  const min = (options.layer_min_mm = layer("layerMin"));
  const max = (options.layer_max_mm = layer("layerMax"));
  if (min > max) faults.layerMax = { kind: "upsideDown" };
  if (strength !== "none" && settings.floating === "allow") options.allow_floating = true;
  // Other models of the plate may have supports where this one has none.
  if (strength !== "none" && planner !== "uniform" && settings.supportLayer.trim() !== "") {
    options.support_layer_mm = layer("supportLayer");
    if (min > options.support_layer_mm) faults.supportLayer = { kind: "upsideDown" };
  }

  const typed = settings.tolerances[metric] ?? "";
  if (typed.trim() !== "") {
    const { tolerances, scale } = METRICS[metric];
    options.tolerance = within("tolerance", typed, tolerances) / scale;
  }

  const resin: Resin = { ...resins.find(({ name }) => name === settings.resin) };
  if (settings.exposure.trim() !== "") resin.exposure_s = within("exposure", settings.exposure, USUAL.exposure_s);
  if (settings.bottomExposure.trim() !== "") {
    resin.bottom_exposure_s = within("bottomExposure", settings.bottomExposure, USUAL.exposure_s);
  }
  if (settings.bottomLayers.trim() !== "") {
    const layers = (resin.bottom_layers = within("bottomLayers", settings.bottomLayers, USUAL.bottom_layers));
    if (!Number.isInteger(layers)) faults.bottomLayers ??= { kind: "whole" };
  }
  if (settings.penetration.trim() !== "") resin.penetration_mm = within("penetration", settings.penetration, USUAL.penetration_mm);
  if (settings.overcure.trim() !== "") resin.print_through = { ...resin.print_through, overcure_mm: within("overcure", settings.overcure, USUAL.overcure_mm) };
  if (resin.print_through && settings.retained.trim() !== "") resin.print_through.retained = within("retained", settings.retained, USUAL.retained);
  if (Object.keys(resin).length > 0) options.resin = resin;

  const rotation = quaternion(settings.rotation);
  if (rotation !== null) options.rotation = rotation;

  return Object.keys(faults).length === 0 ? { ok: true, options } : { ok: false, faults };
}

/** Explains a fault to the user. */
export function faultWords(fault: Fault, { texts: { faults }, format }: Language): string {
  switch (fault.kind) {
    case "upsideDown":
    case "whole":
    case "grouped":
      return faults[fault.kind];
    case "unit":
      return faults.unit({ units: format.either(UNITS_SHOWN[fault.unit]) });
    default: {
      const { kind, value, least, most, unit } = fault;
      const range = faults.between({ least: format.tick(least), most: format.tick(most), unit: unit === "" || unit === "°" ? unit : ` ${unit}` });
      const words = faults[kind]({ range });
      if (value === null) return words;
      const asMicrometres = value / 1000;
      const isSlip = unit === "mm" && value > most && asMicrometres >= least && most < USUAL.height_mm[1];
      return isSlip ? `${words} ${faults.micrometres({ typed: format.tick(value), mm: format.tick(asMicrometres) })}` : words;
    }
  }
}

/** Number of a setting; null if invalid. */
export function parse(text: string): number | null {
  return read(text, "").value;
}

/** Unit quaternion x, y, z, w of the setting `rotation`; null if empty or invalid. */
export function quaternion(text: string): [number, number, number, number] | null {
  const [x = NaN, y = NaN, z = NaN, w = NaN, ...more] = text.split(",").map(Number);
  const length = Math.hypot(x, y, z, w);
  return more.length === 0 && length > 0 ? [x / length, y / length, z / length, w / length] : null;
}

/** The setting `rotation` for a unit quaternion: six decimals, and empty for the identity. */
export function rotationText(rotation: readonly number[]): string {
  const text = rotation.map((part) => String(Number(part.toFixed(6)) + 0)).join();
  return text === "0,0,0,1" ? "" : text;
}
