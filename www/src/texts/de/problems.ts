import type { ProblemTexts } from "../en/problems.js";
import type { Format } from "../format.js";
import { LAYERS, FACETS, EDGES, HOLES } from "./nouns.js";

export const problems = ({ counted }: Format): ProblemTexts => ({
  offers: {
    tolerance: (error) => `Toleranz ${error}`,
    layersFrom: (thickness) => `Schichten ab ${thickness}`,
    rays: (count) => `${count} Strahlen`,
    scale: (height) => `Auf ${height} skalieren`,
    uniform: (thickness) => `Gleichmäßige Schichten von ${thickness}`,
    images: "Als Bilder speichern",
    noPrinter: "Ohne Drucker",
    again: "Noch einmal",
  },
  problems: {
    notStl: (name) => [
      `${name} ist keine STL-Datei`,
      "Cusp liest binäre STL-Dateien und solche aus Text: exportieren Sie Ihr Modell als STL und legen Sie das ab.",
    ],
    empty: (name) => [`${name} ist leer`, "Die Datei enthält keine Dreiecke. Exportieren Sie das Modell noch einmal als STL."],
    cutShort: (name) => [`${name} ist abgeschnitten`, "Das Ende der Datei fehlt. Kopieren oder exportieren Sie sie noch einmal."],
    damaged: (name) => [`${name} ist beschädigt`, "Exportieren Sie das Modell noch einmal als STL und legen Sie die neue Datei ab."],
    unusable: (name) => [`${name} lässt sich nicht schneiden`, "Das Modell hat keine Ausdehnung oder zu große Koordinaten."],
    tooLarge: () => ["Das Modell ist zu groß für diesen Drucker", "Es ist breiter oder tiefer als das Bild des Druckers."],
    tooHigh: () => ["Das Modell ist zu hoch für diesen Drucker", "Es ist höher als der Bauraum."],
    tooFine: () => ["Diese Auflösung ist zu viel für diesen Computer", "Wählen Sie eine gröbere."],
    noHits: (name) => [`${name} ist zu dünn für diese Pixel`, "Kein Pixel trifft das Modell. Wählen Sie eine feinere Auflösung."],
    allBlack: () => ["Jede Maske wäre schwarz", "Das Modell umschließt nichts. Prüfen Sie es, oder wählen Sie dünnere Schichten."],
    layerTooThick: () => ["Die Schichten sind zu dick für dieses Modell", "Wählen Sie dünnere."],
    rangeEmpty: () => ["Kein ganzer Motorschritt liegt in diesem Bereich", "Erweitern Sie den Bereich der Schichtdicken."],
    doNotFit: () => ["Diese Schichten ergeben nicht die Höhe des Modells", "Erweitern Sie den Bereich der Schichtdicken."],
    notWhole: () => ["Diese Längen passen nicht zueinander", "Eine davon ist kein Vielfaches des Schritts."],
    badRange: () => ["Diese Höhenbereiche passen nicht zueinander", "Sie überlappen sich oder sind verkehrt herum."],
    badPlane: () => ["In dieser Höhe kann keine Ebene liegen", "Sie muss innerhalb des Modells sein."],
    badTime: () => ["Diese Zeiten sind nicht möglich", "Geben Sie Sekunden ab 0 ein."],
    badOptions: () => ["Diese Einstellungen passen nicht zueinander", "Eine davon ist unbekannt oder widerspricht einer anderen."],
    outOfReach: () => ["So kurz ist kein Plan", "Erlauben Sie mehr Schichten, mehr Zeit oder dickere Schichten."],
    gpu: () => ["Die GPU ließ sich nicht benutzen", "Ohne sie rechnet die CPU."],
    gpuTooSmall: () => ["Die GPU ist zu klein für dieses Modell", "Ohne sie rechnet die CPU."],
    uniformOnly: () => [
      "Diese Druckdatei nimmt nur gleichmäßige Schichten",
      "Sie hat eine Dicke für alle Schichten, und dieser Plan hat mehrere.",
    ],
    unreadable: (name) => [
      `${name} ließ sich nicht öffnen`,
      "Vielleicht wurde die Datei verschoben, geändert oder gesperrt. Wählen Sie sie noch einmal.",
    ],
    notFetched: (name) => [`${name} ließ sich nicht laden`, "Unter dieser Adresse kam keine Datei. Versuchen Sie es noch einmal."],
    startFailed: (_, message) => [
      "Der Slicer ließ sich nicht starten",
      `Laden Sie die Seite neu. Hilft das nicht, ist dieser Browser vielleicht zu alt für WebAssembly. (${message})`,
    ],
    crash: (_, message) => [
      "Der Slicer hat angehalten",
      `Vielleicht reichte der Speicher nicht. Er ist neu gestartet: versuchen Sie es noch einmal, bei einem großen Modell mit weniger Strahlen. (${message})`,
    ],
    notWeights: (name) => [`${name} enthält keine Gewichte`, "Wählen Sie eine Datei mit Gewichten, die für dieses Modell gespeichert wurde."],
    otherMesh: (name) => [`${name} gehört zu einem anderen Modell`, "Wählen Sie eine Datei mit Gewichten, die für dieses Modell gespeichert wurde."],
    other: (_, message) => ["Das hat nicht geklappt", message],
  },
  infeasible: {
    title: (tolerance) => `Kein Plan hält überall ${tolerance} ein`,
    where: (from, to, thinnest) =>
      `Von ${from} bis ${to} lässt selbst eine Schicht von ${thinnest}, die dünnste erlaubte, einen größeren Fehler.`,
    either: "Erlauben Sie einen größeren Fehler oder, wenn Ihr Drucker es kann, dünnere Schichten.",
    larger: "Erlauben Sie einen größeren Fehler.",
    thinner: "Erlauben Sie dünnere Schichten, wenn Ihr Drucker es kann.",
    neither: "Ändern Sie den Bereich der Schichten.",
  },
  otherKind: {
    title: (name, kind) => `${name} ist eine Datei anderer Art: ${kind}`,
    model: "Cusp liest STL. Exportieren Sie das Modell als STL, und öffnen Sie diese Datei.",
    packed: "Entpacken Sie die Datei, und öffnen Sie das STL darin.",
    page: "Das ist eine Webseite, kein Modell. Laden Sie das Modell selbst herunter: Vielleicht verlangt die Adresse eine Anmeldung, oder sie führt zu einer Seite über das Modell.",
  },
  warnings: {
    "degenerate-facets": (facets) => `${counted(facets, FACETS)} ohne Fläche weggelassen.`,
    "inside-out": () => "Das Netz war von innen nach außen gekehrt und wurde umgedreht.",
    "open-mesh": (edges, holes) =>
      `Das Netz ist nicht geschlossen: ${counted(edges, EDGES)} ohne Gegenstück, ${counted(holes, HOLES)} eben geschlossen. Sehen Sie sich die Masken an.`,
    "unclosed-rays": (unclosed, rays) =>
      `${unclosed} von ${rays} Strahlen gehen durch Löcher des Netzes, die eben geschlossen sind. Sehen Sie sich die Masken an.`,
    "tolerance-exceeded": (error, tolerance) => `Der Fehler erreicht ${error}, mehr als die Toleranz von ${tolerance}.`,
    "tolerance-exceeded-on-mesh": (error, tolerance) =>
      `Am Netz selbst erreicht der Fehler ${error}, mehr als die Toleranz von ${tolerance}: Strahlen verfehlen einen Teil der Oberfläche.`,
    "sampled-sections": () => "Die Oberfläche schneidet sich selbst; Querschnitte werden entlang von Strahlen gezählt.",
    "top-moved": (top, height) => `Der Druck endet bei ${top}, weil die Schichten nicht genau ${height} ergeben.`,
    "black-layers": (layers, from) =>
      `${counted(layers, LAYERS)} ohne belichteten Pixel, ab ${from}: Teile schweben in der Luft oder sind dünner als ein Pixel. Sehen Sie sich dort die Masken an.`,
    "gpu-too-small": () => "Das Modell passt nicht in den Speicher der GPU; die CPU hat ihre Arbeit übernommen.",
    "gpu-failed": (reason) => `Die GPU hat versagt, und die CPU hat ihre Arbeit übernommen. (${reason})`,
  },
});
