/** What is counted: one, and several. */
export const LAYERS = { one: "layer", other: "layers" };
export const FACETS = { one: "facet", other: "facets" };
export const EDGES = { one: "edge", other: "edges" };
export const HOLES = { one: "hole", other: "holes" };
