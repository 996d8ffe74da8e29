/** German. */
import type { PageWords } from "./index.js";

export const words: PageWords = {
  title: "Cusp: adaptive Schichten für den Resindruck",
  tagline: "Dünne Schichten, wo die Oberfläche sie braucht, dicke, wo nicht.",
  private: "Ihr Modell verlässt diesen Computer nie.",
  drop: "Zum Öffnen loslassen",
  languages: "Sprache",
  noModel: "Kein Modell zur Hand?",
  tryExample: "Das Beispiel ausprobieren",
  printFile: "Druckdatei ansehen",
  example: "Beispiel",
  recent: "Letzte Modelle",
  saved: "Profile",
  keys: "Tasten",
  points: [
    ["So wenige Schichten wie möglich", "Unter allen Plänen innerhalb Ihrer Toleranz wird der kürzeste genommen."],
    ["Keine Stufe zu hoch", "Die Toleranz gilt in jeder Schicht, nicht im Mittel."],
    ["Eine Datei zum Drucken", "Für namentlich bekannte Drucker oder als Bilder der Schichten mit ihrer Dicke, in einem Zip."],
  ],
};
