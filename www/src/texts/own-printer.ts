/** Texts of the form for a printer of one's own, fetched with it. */
import { room } from "./messages.js";

export const ownPrinterTexts = room("own", {
  name: "Name",
  width: "Pixels across",
  depth: "Pixels deep",
  pitch: "Pixel width (µm)",
  pitchY: "Pixel depth (µm)",
  height: "Height (mm)",
  mirrored: "The screen lights from below (images are mirrored)",
  layers: "Layers of several thicknesses",
});
