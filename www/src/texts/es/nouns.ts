/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "capa", other: "capas" };
export const FACETS = { one: "faceta", other: "facetas" };
export const OMITTED = { one: "omitida", other: "omitidas" };
export const EDGES = { one: "arista", other: "aristas" };
export const HOLES = { one: "agujero tapado", other: "agujeros tapados" };
export const OBJECTS = { one: "objeto", other: "objetos" };
export const PARTS = { one: "parte", other: "partes" };
export const ISLANDS = { one: "isla", other: "islas" };
export const POINTS = { one: "punto queda", other: "puntos quedan" };
