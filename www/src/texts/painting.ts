/** Texts for painting weights, fetched with their panel. */
import { room } from "./messages.js";

export const paintingTexts = room("painting", {
  title: "Paint important areas",
  hint: "The tolerance holds where the weight is 100%. Where something matters less, layers may be thicker. Paint on the model; drag beside it to turn the view.",
  brush: "Brush",
  modes: { less: "Matters less", more: "Matters more", erase: "Erase", soften: "Soften" },
  size: "Size (mm)",
  strength: "Strength",
  fills: "Fill a smooth region",
  crease: "Up to edges of",
  mirrors: "Mirror left and right",
  base: "Unpainted weight",
  least: "Least weight",
  saliency: "What stands out matters more",
  show: "Show",
  colours: { paint: "Painted weight", saliency: "What stands out", product: "Weight that counts", layers: "Layer thickness" },
  finding: "Finding what stands out",
  undo: "Undo stroke",
  redo: "Redo stroke",
  clear: "Clear",
  save: "Save weights",
  open: "Load weights",
});
