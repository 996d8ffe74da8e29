import type { OfferTexts } from "../en/offers.js";
import type { Format } from "../format.js";
import { LAYERS, UNITS } from "./nouns.js";

export const offers = (format: Format): OfferTexts => ({
  tolerance: (error) => `Tolérance ${error}`,
  layersFrom: (thickness) => `Couches dès ${thickness}`,
  rays: (count) => `${count} rayons`,
  scale: (height) => `Mettre à ${height}`,
  uniform: (thickness) => `Couches uniformes de ${thickness}`,
  bestUniform: (thickness, layers) => `Couches uniformes de ${thickness} (${format.counted(layers, LAYERS)})`,
  images: "Enregistrer en images",
  noPrinter: "Sans imprimante",
  unit: (unit) => `Il est en ${UNITS[unit]}`,
  again: "Réessayer",
});
