import type { PlateTexts } from "../en/plate.js";

export const plate = (): PlateTexts => ({
  plate: {
    add: "Ajouter un modèle",
    copies: "Copies",
    copiesOf: (name) => `Copies de ${name}`,
    fewer: "Une de moins",
    more: "Une de plus",
    arrange: "Disposer",
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
    others: (count) => `Et ${count} autres.`,
    moved: "Les copies sont là où elles ont été déplacées.",
  },
});
