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
  plate: {
    add: "Añadir modelo",
    copies: "Copias",
    copiesOf: (name) => `Copias de ${name}`,
    fewer: "Una menos",
    more: "Una más",
    arrange: "Distribuir",
    quality: "La curva de calidad es de un solo modelo. Una placa se planifica con la tolerancia de los ajustes.",
  },
};
