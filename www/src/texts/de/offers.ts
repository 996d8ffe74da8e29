import type { OfferTexts } from "../en/offers.js";
import type { Format } from "../format.js";
import { LAYERS, UNITS } from "./nouns.js";

export const offers = (format: Format): OfferTexts => ({
  tolerance: (error) => `Toleranz ${error}`,
  layersFrom: (thickness) => `Schichten ab ${thickness}`,
  rays: (count) => `${count} Strahlen`,
  scale: (height) => `Auf ${height} skalieren`,
  uniform: (thickness) => `Gleichmäßige Schichten von ${thickness}`,
  bestUniform: (thickness, layers) => `Gleichmäßige Schichten von ${thickness} (${format.counted(layers, LAYERS)})`,
  images: "Als Bilder speichern",
  noPrinter: "Ohne Drucker",
  unit: (unit) => `Es ist in ${UNITS[unit]}`,
  again: "Noch einmal",
});
