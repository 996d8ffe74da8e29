/** Nouns that are counted, in the singular and the plural. */
export const LAYERS = { one: "Schicht", other: "Schichten" };
export const FACETS = { one: "Dreieck", other: "Dreiecke" };
export const EDGES = { one: "Kante", other: "Kanten" };
export const HOLES = { one: "Loch", other: "Löcher" };
export const OBJECTS = { one: "Objekt", other: "Objekte" };
export const PARTS = { one: "Teil", other: "Teile" };
export const ISLANDS = { one: "Insel", other: "Inseln" };
export const POINTS = { one: "Punkt bleibt", other: "Punkte bleiben" };
