import type { PaintingTexts } from "./index.js";

export const painting: PaintingTexts = {
  title: "Qué importa",
  hint: "La tolerancia se cumple donde el peso es 100 %. Donde algo importa menos, las capas pueden ser más gruesas. Pinte sobre el modelo; arrastre a su lado para girar la vista.",
  brush: "Pincel",
  modes: { less: "Importa menos", more: "Importa más", erase: "Borrar", soften: "Suavizar" },
  size: "Tamaño (mm)",
  strength: "Intensidad",
  fills: "Rellenar una zona lisa",
  crease: "Hasta aristas de",
  mirrors: "Reflejar izquierda y derecha",
  base: "Peso sin pintar",
  least: "Peso mínimo",
  saliency: "Lo que destaca importa más",
  show: "Mostrar",
  colours: { paint: "Peso pintado", saliency: "Lo que destaca", product: "Peso que cuenta", layers: "Espesor de capa" },
  finding: "Buscando lo que destaca",
  undo: "Deshacer trazo",
  redo: "Rehacer trazo",
  clear: "Vaciar",
  save: "Guardar pesos",
  open: "Cargar pesos",
};
