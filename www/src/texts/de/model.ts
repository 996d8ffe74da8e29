import type { ModelTexts } from "../en/model.js";

export const model = (): ModelTexts => ({
  open: {
    region: "Modell öffnen",
    drop: "Modell hier ablegen",
    choose: "Datei auswählen",
    another: "Weitere öffnen",
    opening: (name) => `${name} wird geöffnet`,
    place: (place, total) => `Modell ${place} von ${total}`,
    previous: "Voriges Modell",
    next: "Nächstes Modell",
  },
  model: {
    region: "Das Modell",
    size: "Größe",
    sizeHelp: "Breite × Tiefe × Höhe",
    scaled: (from) => `skaliert von ${from}`,
    facets: "Dreiecke",
    surface: "Oberfläche",
    closed: "Geschlossen",
    open: "Nicht geschlossen",
  },
  progress: {
    load: "Modell wird gelesen",
    saliency: "Auffälliges wird gesucht",
    ldi: "Form wird abgetastet",
    profile: "Oberfläche wird gemessen",
    plan: "Schichten werden geplant",
    masks: "Schichten werden gezeichnet",
    inspect: "Druckprobleme werden gesucht",
    orientation: "Richtungen werden gemessen",
    left: (seconds) => `noch etwa ${seconds}`,
    cancel: "Abbrechen",
  },
  notices: {
    cancelled: "Abgebrochen.",
    exportCancelled: "Der Download wurde abgebrochen.",
    partFailed: "Dieser Teil der Seite ließ sich nicht laden. Prüfen Sie die Verbindung und versuchen Sie es noch einmal; hilft das nicht, laden Sie die Seite neu.",
    close: "Schließen",
  },
});
