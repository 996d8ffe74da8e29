/**
 * Single source of the properties that a page may set on `<cusp-slicer>`: Lit's declarations, the checks of attributes and the types for
 * frameworks derive from it. A test compares the class with it.
 */
import type { PropertyDeclaration } from "lit";
import type { Backend, GpuMethod } from "../api/wire.js";
import { currentName, METRIC_NAMES } from "./state/metric.js";
import { PANELS } from "./state/panel-names.js";
import { fraction, languageTag, number, oneOf, printer, someOf, text, type Reader } from "./state/readers.js";
import { FORMATS } from "../api/facts.js";
import type { Settings } from "./state/settings.js";

/** A property that is also an attribute. */
interface Attribute {
  readonly attribute: string;
  /** Reads and checks a value; absent for a URL, which is checked when it is fetched. */
  readonly read?: Reader<unknown>;
  /** The setting that the attribute sets. */
  readonly sets?: keyof Settings;
}

type Attributes = Readonly<Record<string, Attribute>>;

/** A list of properties, keyed by attribute. */
type ByAttribute<List extends Attributes> = { readonly [Name in keyof List as List[Name]["attribute"]]: List[Name] };

function byAttribute<List extends Attributes>(list: List): ByAttribute<List> {
  return Object.fromEntries(Object.values(list).map((it) => [it.attribute, it])) as ByAttribute<List>;
}

/** In order of application: the metric precedes the tolerance, which is in its unit. */
const SETTING_PROPERTIES = {
  printer: { attribute: "printer", read: printer, sets: "printer" },
  format: { attribute: "format", read: oneOf(FORMATS), sets: "format" },
  resin: { attribute: "resin", read: text, sets: "resin" },
  metric: { attribute: "metric", read: (said) => oneOf(METRIC_NAMES)(currentName(String(said))), sets: "metric" },
  tolerance: { attribute: "tolerance", read: number, sets: "tolerances" },
  layerMax: { attribute: "layer-max", read: number, sets: "layerMax" },
  layerMin: { attribute: "layer-min", read: number, sets: "layerMin" },
} as const satisfies Attributes;

/** Attributes that are settings. */
export const SETTINGS = byAttribute(SETTING_PROPERTIES);

export type SettingName = keyof typeof SETTINGS;

export const SETTING_NAMES = Object.keys(SETTINGS) as SettingName[];

const BACKENDS = ["cpu", "gpu"] as const satisfies readonly Backend[];
const GPU_METHODS = ["fill", "peel"] as const satisfies readonly GpuMethod[];

const ATTRIBUTE_PROPERTIES = {
  src: { attribute: "src" },
  ...SETTING_PROPERTIES,
  quality: { attribute: "quality", read: fraction },
  fixed: { attribute: "fixed", read: someOf(SETTING_NAMES) },
  locale: { attribute: "locale", read: languageTag },
  panels: { attribute: "panels", read: someOf(PANELS) },
  backend: { attribute: "backend", read: oneOf(BACKENDS) },
  gpuMethod: { attribute: "gpu-method", read: oneOf(GPU_METHODS) },
  assets: { attribute: "assets" },
} as const satisfies Attributes;

export const ATTRIBUTES = byAttribute(ATTRIBUTE_PROPERTIES);

/** All settable properties, with their attribute if they have one. */
export const PROPERTIES = { ...ATTRIBUTE_PROPERTIES, weights: null, resins: null, prices: null, finish: null, limits: null, query: null } as const;

export type PropertyName = keyof typeof PROPERTIES;

/** Read-only properties; `state` is reflected in an attribute of that name. */
export const READ_ONLY = ["state", "model", "models", "result", "plates", "price", "check"] as const;

/** Declarations for Lit. All except `src` have their own setters, which receive an attribute's text unconverted. */
export const DECLARATIONS: Readonly<Record<string, PropertyDeclaration>> = {
  ...Object.fromEntries(
    Object.entries(ATTRIBUTE_PROPERTIES).map(([name, { attribute }]) => [
      name,
      { attribute, noAccessor: true, converter: { fromAttribute: (text: string | null) => text } },
    ]),
  ),
  src: { type: String },
};
