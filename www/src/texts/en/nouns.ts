/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "layer", other: "layers" };
export const FACETS = { one: "facet", other: "facets" };
export const EDGES = { one: "edge", other: "edges" };
export const HOLES = { one: "hole", other: "holes" };
export const OBJECTS = { one: "object", other: "objects" };
export const PARTS = { one: "part", other: "parts" };
export const ISLANDS = { one: "island", other: "islands" };
export const POINTS = { one: "point", other: "points" };
