/** German. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Ergebnisse zeigen",
  answers: "Ergebnis",
  mask: "Maske",
  result: "Ergebnis",
  more: "Ergebnis zeigen",
  layer: "Schicht in der Ansicht",
  exposure: (seconds, thickness) => `${seconds} Belichtung für ${thickness}`,
  path: "Schritte",
  steps: { turn: "Drehen", check: "Prüfen", hollow: "Aushöhlen", support: "Stützen", slice: "Slicen" },
  hints: {
    turn: "Wie das Modell liegt, entscheidet, was Stützen braucht und wie lange es druckt.",
    check: "Was beim Druck misslingen würde, und wo.",
    hollow: "Ein hohles Modell braucht weniger Harz und zieht weniger an der Folie.",
    support: "Was in der Luft beginnt oder weit auslädt, braucht Stützen.",
    slice: "Womit drucken Sie?",
  },
  back: "Zurück",
  next: (step) => `Weiter: ${step}`,
  byHand: { rotate: "Von Hand drehen", drains: "Löcher von Hand setzen", supports: "Punkte von Hand setzen" },
  filament: "Das tun Slicer für Filamentdrucker selbst.",
  states: {
    asFile: "Wie in der Datei",
    turned: "Gedreht",
    unchecked: "Ungeprüft",
    verdicts: { ok: "Nichts gefunden", review: "Besser ansehen", reject: "Misslingt so" },
    solid: "Voll",
    walls: (thickness) => `Wände: ${thickness}`,
    supports: (strength, points, { counted }) => `${strength}, ${counted(points, { one: "Punkt", other: "Punkte" })}`,
    missing: (points, { counted }) => `${counted(points, { one: "Punkt", other: "Punkte" })} ohne Stütze`,
    wrong: "Zu berichtigen",
  },
};
