import type { ViewWords } from "../en/view.js";
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

export const view = ({ counted }: Format): ViewWords => ({
  view: {
    region: "Das Modell in drei Dimensionen",
    title: "Modell",
    kind: "3-D-Ansicht",
    keys: {
      turn: "Pfeiltasten drehen die Ansicht, Plus und Minus vergrößern und verkleinern, 0 zeigt das ganze Modell.",
      move: "Pfeiltasten verschieben die gewählte Kopie um 1 mm, mit der Umschalttaste um 10 mm; R dreht sie um 15°, mit der Umschalttaste um 45°.",
      rotate: "Pfeiltasten, Bild auf und Bild ab drehen das Modell um 5°, mit der Umschalttaste um 1°.",
      flat: "Eingabe legt die Fläche in der Mitte auf die Platte. Pfeiltasten drehen die Ansicht.",
      paint: "Eingabe malt in der Mitte der Ansicht, Strg+Z nimmt es zurück. Pfeiltasten drehen die Ansicht.",
      supports: "Eingabe setzt einen Punkt in die Mitte der Ansicht. Pfeiltasten gehen von Punkt zu Punkt, Entf entfernt einen, L sperrt ihn. Pfeiltasten mit der Umschalttaste drehen die Ansicht.",
      drains: "Eingabe setzt ein Loch in die Mitte der Ansicht. Pfeiltasten gehen von Loch zu Loch, Entf entfernt eins, L sperrt es. Pfeiltasten mit der Umschalttaste drehen die Ansicht.",
    },
    empty: "Noch kein Modell",
    legend: "Schichtdicke (µm)",
    heat: "Wie sehr es zählt",
    distance: "Abstand vom Modell (µm)",
    walls: "Wandstärke (mm)",
    layers: (count) => counted(count, LAYERS),
    layer: (layer, height, thickness) => `Schicht ${layer} · ${height} · ${thickness}`,
    grid: (step) => `Raster ${step}`,
    building: (part) => `Stufen werden berechnet: ${part}`,
    measuring: (part) => `Abstände werden gemessen: ${part}`,
    thin: (least) => `Dünner als ${least}`,
    probing: (part) => `Wände werden gemessen: ${part}`,
    unavailable: "Dieser Browser zeigt keine 3-D-Ansicht: WebGL 2 ist abgeschaltet oder fehlt.",
    lost: "Der Browser hat die 3-D-Ansicht angehalten. Das Modell und sein Plan sind noch da.",
    again: "Wieder zeigen",
    tools: { turn: "Umsehen", move: "Auf der Platte verschieben", rotate: "Modell drehen", flat: "Fläche hinlegen", paint: "Was zählt", supports: "Stützpunkte", drains: "Ablauflöcher" },
    modes: "Modus",
    switches: "Anzeige",
    impossible: "Diese Werkzeuge brauchen die 3-D-Ansicht, und die ist nicht verfügbar.",
    printed: "Wie gedruckt",
    measured: "Abstand vom Modell",
    safe: "Für Farbenblinde",
    aligned: "Neben dem Profil",
    upright: "Wie in der Datei",
  },
});
