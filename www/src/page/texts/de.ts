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
  notices: {
    part: "Dieser Teil der Seite ließ sich nicht laden; vielleicht hat eine neuere Fassung ihn ersetzt. Laden Sie die Seite neu.",
    reader: (name) => `Der Leser für Druckdateien ließ sich nicht laden, daher ist ${name} nicht offen. Laden Sie die Seite neu, und öffnen Sie die Datei noch einmal.`,
    notKept: (name) => `${name} wurde nicht für den nächsten Besuch aufgehoben: Dieser Browser hat keinen Platz dafür oder erlaubt es nicht.`,
    reload: "Neu laden",
    close: "Schließen",
  },
  points: [
    ["So wenige Schichten wie möglich", "Unter allen Plänen innerhalb Ihrer Toleranz wird der kürzeste genommen."],
    ["Keine Stufe zu hoch", "Die Toleranz gilt in jeder Schicht, nicht im Mittel."],
    ["Eine Datei zum Drucken", "Für namentlich bekannte Drucker oder als Bilder der Schichten mit ihrer Dicke, in einem Zip."],
  ],
};
