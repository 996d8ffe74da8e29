/** Labels of offers. */
import type { ModelUnit } from "../../api/wire.js";
import type { Format } from "../format.js";
import { LAYERS, UNITS } from "./nouns.js";

export const offers = (format: Format) => ({
  tolerance: (error: string) => `Tolerance ${error}`,
  layersFrom: (thickness: string) => `Layers from ${thickness}`,
  rays: (count: string) => `${count} rays`,
  scale: (height: string) => `Scale to ${height}`,
  uniform: (thickness: string) => `Uniform layers of ${thickness}`,
  bestUniform: (thickness: string, layers: number) => `Uniform layers of ${thickness} (${format.counted(layers, LAYERS)})`,
  images: "Save as images",
  noPrinter: "Without a printer",
  unit: (unit: ModelUnit) => `It is in ${UNITS[unit]}`,
  again: "Try again",
});

export type OfferTexts = ReturnType<typeof offers>;
