/** Spanish. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Qué elegir",
  answers: "Qué sale",
  mask: "Máscara",
  result: "Resultado",
  more: "Mostrar el resultado",
  layer: "Capa en la vista",
  exposure: (seconds, thickness) => `${seconds} de exposición para ${thickness}`,
};
