/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "couche", other: "couches" };
export const FACETS = { one: "facette", other: "facettes" };
export const OMITTED = { one: "omise", other: "omises" };
export const EDGES = { one: "arête", other: "arêtes" };
export const HOLES = { one: "trou bouché", other: "trous bouchés" };
export const OBJECTS = { one: "objet", other: "objets" };
export const PARTS = { one: "partie", other: "parties" };
export const ISLANDS = { one: "îlot", other: "îlots" };
export const POINTS = { one: "point reste", other: "points restent" };
