import type { ModelUnit, PartKind } from "../../api/wire.js";
import type { GpuFaults } from "../sentences.js";

/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "capa", other: "capas" };
export const FACETS = { one: "faceta", other: "facetas" };
export const OMITTED = { one: "omitida", other: "omitidas" };
export const EDGES = { one: "arista", other: "aristas" };
export const HOLES = { one: "agujero tapado", other: "agujeros tapados" };
export const OBJECTS = { one: "objeto", other: "objetos" };
export const PARTS = { one: "parte", other: "partes" };
export const CAVITIES = { one: "cavidad", other: "cavidades" };
export const BODIES = { one: "cuerpo del modelo falta", other: "cuerpos del modelo faltan" };
export const ISLANDS = { one: "isla", other: "islas" };
export const POINTS = { one: "punto queda", other: "puntos quedan" };

export const UNITS: Readonly<Record<ModelUnit, string>> = {
  ...{ micron: "micrómetros", millimeter: "milímetros", centimeter: "centímetros" },
  ...{ inch: "pulgadas", foot: "pies", meter: "metros" },
};

export const FAULTS: GpuFaults = {
  error: "el sistema informa de un error",
  "device-lost": "se perdió el dispositivo",
  "too-many-hits": "el modelo tiene más puntos de superficie de los que caben en sus búferes",
  "bad-offsets": "devolvió posiciones que no cuadran",
  "out-of-memory": "no hubo memoria suficiente",
};

export const PART_KINDS: Readonly<Record<PartKind, string>> = {
  negative: "parte negativa",
  modifier: "modificador",
  "support-blocker": "bloqueador de soportes",
  "support-enforcer": "forzador de soportes",
};
