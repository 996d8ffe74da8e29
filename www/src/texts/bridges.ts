/** Texts for test bridges, which measure the print-through of a resin, fetched with their table. */
import { room } from "./messages.js";

export const bridgesTexts = room("bridges", {
  hint: "Bridges of several layers on a small print. Print it, wash and cure it, and type how thick each bridge is.",
  download: "Download test bridges",
  caption: "Measured thickness in mm",
  layers: "Layers",
  cell: "{layers} layers of {thickness}",
  fitted: "Fits to {residual}. Overcure {overcureLeast} to {overcureMost}\u00a0mm, penetration {penetrationLeast} to {penetrationMost}\u00a0mm, retained dose {retainedLeast} to {retainedMost}.",
});
