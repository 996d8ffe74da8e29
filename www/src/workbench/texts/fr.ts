/** French. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Les choix",
  answers: "Le résultat",
  mask: "Masque",
  result: "Résultat",
  more: "Afficher le résultat",
  layer: "Couche dans la vue",
  exposure: (seconds, thickness) => `${seconds} d’exposition pour ${thickness}`,
};
