/** Texts of the mask's tools, fetched with its panel. */
import { room } from "./messages.js";

export const maskingTexts = room("mask", {
  fit: "Fit to the model",
  full: "Fill the screen",
  changes: "Changes from the layer below",
  /** Legend of the changes. */
  grown: "New in this layer",
  gone: "Only in the layer below",
  measure: "Measure between two points",
  exposure: "Exposure",
  area: "Lit area",
  pull: "Pull of the film",
  pullHelp: "The force that peels the layer off the film, without the suction of hollows. Known once the plan is checked.",
});
