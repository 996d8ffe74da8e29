import type { PaintingTexts } from "./index.js";

export const painting: PaintingTexts = {
  title: "Ce qui compte",
  hint: "La tolérance est tenue là où le poids est de 100 %. Ce qui compte moins peut avoir des couches plus épaisses. Peignez sur le modèle ; glissez à côté pour tourner la vue.",
  brush: "Pinceau",
  modes: { less: "Compte moins", more: "Compte plus", erase: "Effacer", soften: "Adoucir" },
  size: "Taille (mm)",
  strength: "Force",
  fills: "Remplir une zone lisse",
  crease: "Jusqu’aux arêtes de",
  mirrors: "Miroir gauche et droite",
  base: "Poids sans peinture",
  least: "Poids minimal",
  saliency: "Ce qui ressort compte plus",
  show: "Afficher",
  colours: { paint: "Poids peint", saliency: "Ce qui ressort", product: "Poids qui compte", layers: "Épaisseur de couche" },
  finding: "Recherche de ce qui ressort",
  undo: "Annuler le trait",
  redo: "Rétablir le trait",
  clear: "Vider",
  save: "Enregistrer les poids",
  open: "Charger des poids",
};
