import type { ModelUnit, PartKind } from "../../api/wire.js";
import type { GpuFaults } from "../sentences.js";

/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "Schicht", other: "Schichten" };
export const FACETS = { one: "Dreieck", other: "Dreiecke" };
export const EDGES = { one: "Kante", other: "Kanten" };
export const HOLES = { one: "Loch", other: "Löcher" };
export const OBJECTS = { one: "Objekt", other: "Objekte" };
export const PARTS = { one: "Teil", other: "Teile" };
export const CAVITIES = { one: "Hohlraum bleibt", other: "Hohlräume bleiben" };
export const BODIES = { one: "Körper des Modells fehlt", other: "Körper des Modells fehlen" };
export const ISLANDS = { one: "Insel", other: "Inseln" };
export const POINTS = { one: "Punkt bleibt", other: "Punkte bleiben" };

export const UNITS: Readonly<Record<ModelUnit, string>> = {
  ...{ micron: "Mikrometern", millimeter: "Millimetern", centimeter: "Zentimetern" },
  ...{ inch: "Zoll", foot: "Fuß", meter: "Metern" },
};

export const FAULTS: GpuFaults = {
  error: "das System meldet einen Fehler",
  "device-lost": "das Gerät ging verloren",
  "too-many-hits": "das Modell hat mehr Oberflächenpunkte, als ihre Puffer fassen",
  "bad-offsets": "sie lieferte Positionen, die nicht zusammenpassen",
  "out-of-memory": "der Speicher reichte nicht",
};

export const PART_KINDS: Readonly<Record<PartKind, string>> = {
  negative: "Negativteil",
  modifier: "Modifikator",
  "support-blocker": "Stützenblocker",
  "support-enforcer": "Stützenverstärker",
};
