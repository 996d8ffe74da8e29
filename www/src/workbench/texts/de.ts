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
};
