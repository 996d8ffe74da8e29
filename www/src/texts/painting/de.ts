import type { PaintingTexts } from "./index.js";

export const painting: PaintingTexts = {
  title: "Was zählt",
  hint: "Die Toleranz gilt, wo das Gewicht 100 % ist. Was weniger zählt, darf dickere Schichten haben. Auf dem Modell wird gemalt; Ziehen daneben dreht die Ansicht.",
  brush: "Pinsel",
  modes: { less: "Zählt weniger", more: "Zählt mehr", erase: "Radieren", soften: "Weichzeichnen" },
  size: "Größe (mm)",
  strength: "Stärke",
  fills: "Glatten Bereich füllen",
  crease: "Bis zu Kanten von",
  mirrors: "Links und rechts spiegeln",
  base: "Gewicht ohne Farbe",
  least: "Kleinstes Gewicht",
  saliency: "Auffälliges zählt mehr",
  show: "Zeigen",
  colours: { paint: "Gemaltes Gewicht", saliency: "Auffälliges", product: "Gewicht, das zählt", layers: "Schichtdicke" },
  finding: "Auffälliges wird gesucht",
  undo: "Strich zurück",
  redo: "Strich wiederholen",
  clear: "Leeren",
  save: "Gewichte speichern",
  open: "Gewichte laden",
};
