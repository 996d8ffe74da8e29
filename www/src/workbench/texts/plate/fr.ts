/** French. */
import type { PlateWords } from "./index.js";

export const words: PlateWords = {
  title: "Modèles sur le plateau",
  remove: (name) => `Retirer ${name}`,
  spacing: "Écart (mm)",
  turns: "Rotations",
  turnless: "Aucune",
  step: (degrees) => `Par pas de ${degrees}°`,
  plate: (number, count) => `Plateau ${number} sur ${count}`,
  previous: "Plateau précédent",
  next: "Plateau suivant",
  each: (time, resin) => `${time}, ${resin} chacune`,
  whole: (time, resin) => `Tous les plateaux : ${time}, ${resin}`,
  all: "Télécharger tous les plateaux",
  moved: "Les copies sont là où elles ont été déplacées.",
};
