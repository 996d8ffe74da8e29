/** French. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Voir le résultat",
  answers: "Le résultat",
  mask: "Masque",
  result: "Résultat",
  more: "Afficher le résultat",
  layer: "Couche dans la vue",
  exposure: (seconds, thickness) => `${seconds} d’exposition pour ${thickness}`,
  path: "Étapes",
  steps: { turn: "Tourner", check: "Contrôler", hollow: "Évider", support: "Supports", slice: "Trancher" },
  hints: {
    turn: "De la pose du modèle dépend ce qu’il faut soutenir, et la durée d’impression.",
    check: "Ce qui raterait à l’impression, et où.",
    hollow: "Un modèle creux prend moins de résine et tire moins sur le film.",
    support: "Ce qui commence dans le vide ou déborde beaucoup a besoin de supports.",
    slice: "Dites avec quoi vous imprimez.",
  },
  back: "Retour",
  next: (step) => `Suivant : ${step}`,
  byHand: { rotate: "Tourner à la main", drains: "Placer des trous à la main", supports: "Placer des points à la main" },
  filament: "Les trancheurs d’imprimantes à filament le font eux-mêmes.",
  states: {
    asFile: "Pose du fichier",
    turned: "Tourné",
    unchecked: "Non contrôlé",
    verdicts: { ok: "Rien trouvé", review: "À regarder", reject: "Ratera" },
    solid: "Plein",
    walls: (thickness) => `Parois de ${thickness}`,
    supports: (strength, points, { counted }) => `${strength}, ${counted(points, { one: "point", other: "points" })}`,
    missing: (points, { counted }) => `${counted(points, { one: "point", other: "points" })} sans support`,
    wrong: "À corriger",
  },
};
