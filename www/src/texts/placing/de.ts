import type { PlacingTexts } from "./index.js";

export const placing: PlacingTexts = {
  points: {
    title: "Stützpunkte",
    hint: "Klicken Sie auf das Modell, um einen Punkt zu setzen; ziehen Sie ihn, um ihn zu verschieben.",
    unreached: "Nicht erreicht",
    selected: (number, all, height) => `Punkt ${number} von ${all}, in ${height} Höhe`,
    none: "Kein Punkt ausgewählt",
    lockHint: "Ein gesperrter Punkt bleibt, wenn Punkte automatisch gesetzt werden.",
  },
  drains: {
    title: "Ablauflöcher",
    hint: "Klicken Sie auf das Modell, um ein Loch zu setzen; ziehen Sie es, um es zu verschieben.",
    unreached: "Neben dem Hohlraum",
    selected: (number, all, height) => `Loch ${number} von ${all}, in ${height} Höhe`,
    none: "Kein Loch ausgewählt",
    lockHint: "Ein gesperrtes Loch bleibt, wenn Löcher automatisch gesetzt werden.",
  },
  automatic: "Automatisch",
  byHand: "Von Hand",
  diameter: "Durchmesser (mm)",
  newDiameter: "Durchmesser neuer Löcher (mm)",
  lock: "Gesperrt",
  remove: "Löschen",
  protect: "Punkte und Löcher fernhalten von dem, was als wichtig bemalt ist",
  protectHint: "Gilt für Punkte und Löcher. Zuerst mit „Was zählt“ malen.",
  plugs: "Stopfen herunterladen (STL)",
  plugsHint: "Stifte, die die Löcher schließen: drucken und mit Harz einkleben.",
  automatically: "Automatisch setzen",
  clear: "Alle entfernen",
};
