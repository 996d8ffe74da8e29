/** German. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Auswahl",
  answers: "Ergebnis",
  mask: "Maske",
  result: "Ergebnis",
  more: "Ergebnis zeigen",
  layer: "Schicht in der Ansicht",
  exposure: (seconds, thickness) => `${seconds} Belichtung für ${thickness}`,
  plate: {
    add: "Modell hinzufügen",
    copies: "Kopien",
    copiesOf: (name) => `Kopien von ${name}`,
    fewer: "Eine weniger",
    more: "Eine mehr",
    arrange: "Anordnen",
    quality: "Die Kurve der Qualität gehört zu einem Modell. Eine Platte wird für die Toleranz der Einstellungen geplant.",
  },
};
