import type { ModelUnit, PartKind } from "../../api/wire.js";
import type { GpuFaults } from "../sentences.js";

/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "couche", other: "couches" };
export const FACETS = { one: "facette", other: "facettes" };
export const OMITTED = { one: "omise", other: "omises" };
export const EDGES = { one: "arête", other: "arêtes" };
export const HOLES = { one: "trou bouché", other: "trous bouchés" };
export const OBJECTS = { one: "objet", other: "objets" };
export const PARTS = { one: "partie", other: "parties" };
export const CAVITIES = { one: "cavité", other: "cavités" };
export const BODIES = { one: "corps du modèle manque", other: "corps du modèle manquent" };
export const ISLANDS = { one: "îlot", other: "îlots" };
export const POINTS = { one: "point reste", other: "points restent" };

export const UNITS: Readonly<Record<ModelUnit, string>> = {
  ...{ micron: "micromètres", millimeter: "millimètres", centimeter: "centimètres" },
  ...{ inch: "pouces", foot: "pieds", meter: "mètres" },
};

export const FAULTS: GpuFaults = {
  error: "le système signale une erreur",
  "device-lost": "l’appareil a été perdu",
  "too-many-hits": "le modèle a plus de points de surface que ses tampons n’en contiennent",
  "bad-offsets": "il a rendu des positions incohérentes",
  "out-of-memory": "la mémoire n’a pas suffi",
};

export const PART_KINDS: Readonly<Record<PartKind, string>> = {
  negative: "pièce négative",
  modifier: "modificateur",
  "support-blocker": "bloqueur de supports",
  "support-enforcer": "renfort de supports",
};
