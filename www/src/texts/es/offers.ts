import type { OfferTexts } from "../en/offers.js";
import type { Format } from "../format.js";
import { LAYERS, UNITS } from "./nouns.js";

export const offers = (format: Format): OfferTexts => ({
  tolerance: (error) => `Tolerancia ${error}`,
  layersFrom: (thickness) => `Capas desde ${thickness}`,
  rays: (count) => `${count} rayos`,
  scale: (height) => `Escalar a ${height}`,
  uniform: (thickness) => `Capas uniformes de ${thickness}`,
  bestUniform: (thickness, layers) => `Capas uniformes de ${thickness} (${format.counted(layers, LAYERS)})`,
  images: "Guardar como imágenes",
  noPrinter: "Sin impresora",
  unit: (unit) => `Está en ${UNITS[unit]}`,
  again: "Intentar de nuevo",
});
