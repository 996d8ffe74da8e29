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
  plate: {
    add: "Ajouter un modèle",
    copies: "Copies",
    copiesOf: (name) => `Copies de ${name}`,
    fewer: "Une de moins",
    more: "Une de plus",
    arrange: "Disposer",
    quality: "La courbe de qualité est celle d’un seul modèle. Un plateau est planifié pour la tolérance des réglages.",
  },
};
