/** What is counted: one, and several. */
export const LAYERS = { one: "Schicht", other: "Schichten" };
export const FACETS = { one: "Dreieck", other: "Dreiecke" };
export const EDGES = { one: "Kante", other: "Kanten" };
export const HOLES = { one: "Loch", other: "Löcher" };
