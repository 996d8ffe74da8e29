import type { ModelUnit, PartKind } from "../../api/wire.js";
import type { GpuFaults } from "../sentences.js";

/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "layer", other: "layers" };
export const FACETS = { one: "facet", other: "facets" };
export const EDGES = { one: "edge", other: "edges" };
export const HOLES = { one: "hole", other: "holes" };
export const OBJECTS = { one: "object", other: "objects" };
export const PARTS = { one: "part", other: "parts" };
export const CAVITIES = { one: "cavity of the model stays", other: "cavities of the model stay" };
export const BODIES = { one: "body", other: "bodies" };
export const ISLANDS = { one: "island", other: "islands" };
export const POINTS = { one: "point", other: "points" };

/** Units in the plural, as in "in inches". */
export const UNITS: Readonly<Record<ModelUnit, string>> = {
  ...{ micron: "microns", millimeter: "millimeters", centimeter: "centimeters" },
  ...{ inch: "inches", foot: "feet", meter: "meters" },
};

export const FAULTS: GpuFaults = {
  error: "the system reports an error",
  "device-lost": "the device was lost",
  "too-many-hits": "the model has more surface points than its buffers hold",
  "bad-offsets": "it returned offsets that do not add up",
  "out-of-memory": "there was not enough memory",
};

export const PART_KINDS: Readonly<Record<PartKind, string>> = {
  negative: "negative part",
  modifier: "modifier",
  "support-blocker": "support blocker",
  "support-enforcer": "support enforcer",
};
