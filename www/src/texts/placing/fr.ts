import type { PlacingTexts } from "./index.js";

export const placing: PlacingTexts = {
  points: {
    title: "Points de support",
    hint: "Cliquez sur le modèle pour ajouter un point ; faites-le glisser pour le déplacer.",
    unreached: "Non atteints",
    selected: (number, all, height) => `Point ${number} sur ${all}, à ${height}`,
    none: "Aucun point sélectionné",
    lockHint: "Un point verrouillé reste quand les points sont placés automatiquement.",
  },
  drains: {
    title: "Trous d’évacuation",
    hint: "Cliquez sur le modèle pour ajouter un trou ; faites-le glisser pour le déplacer.",
    unreached: "Hors du vide",
    selected: (number, all, height) => `Trou ${number} sur ${all}, à ${height}`,
    none: "Aucun trou sélectionné",
    lockHint: "Un trou verrouillé reste quand les trous sont placés automatiquement.",
  },
  automatic: "Automatiques",
  byHand: "À la main",
  diameter: "Diamètre (mm)",
  newDiameter: "Diamètre des nouveaux trous (mm)",
  lock: "Verrouillé",
  remove: "Supprimer",
  protect: "Tenir points et trous à l’écart de ce qui est peint comme important",
  protectHint: "Vaut pour les points et les trous. Peignez d’abord avec « Ce qui compte ».",
  plugs: "Télécharger les bouchons (STL)",
  plugsHint: "Des chevilles qui ferment les trous : imprimez-les et collez-les à la résine.",
  automatically: "Placer automatiquement",
  clear: "Tout enlever",
};
