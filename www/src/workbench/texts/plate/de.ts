/** German. */
import type { PlateWords } from "./index.js";

export const words: PlateWords = {
  title: "Modelle auf der Platte",
  remove: (name) => `${name} entfernen`,
  spacing: "Abstand (mm)",
  turns: "Drehungen",
  turnless: "Keine",
  step: (degrees) => `In Schritten von ${degrees}°`,
  plate: (number, count) => `Platte ${number} von ${count}`,
  previous: "Vorige Platte",
  next: "Nächste Platte",
  each: (time, resin) => `je ${time}, ${resin}`,
  whole: (time, resin) => `Alle Platten: ${time}, ${resin}`,
  all: "Alle Platten herunterladen",
  moved: "Die Kopien stehen, wohin sie verschoben wurden.",
};
