import type { PlateTexts } from "../en/plate.js";

export const plate = (): PlateTexts => ({
  plate: {
    add: "Modell hinzufügen",
    copies: "Kopien",
    copiesOf: (name) => `Kopien von ${name}`,
    fewer: "Eine weniger",
    more: "Eine mehr",
    arrange: "Anordnen",
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
    others: (count) => `Und ${count} weitere.`,
    moved: "Die Kopien stehen, wohin sie verschoben wurden.",
  },
});
