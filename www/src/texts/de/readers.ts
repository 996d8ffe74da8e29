import type { ThreeMfFeature, XmlFault } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { ErrorSentences } from "../sentences.js";

const XML: Readonly<Record<XmlFault, string>> = {
  "cut-short": "er endet vor seinen Elementen",
  "not-xml": "er ist kein XML in UTF-8",
  "wrong-end-tag": "ein Endzeichen passt nicht zum Anfang seines Elements",
  attribute: "ein Attribut ist kein Name mit einem Wert in Anführungszeichen",
  "long-tag": "ein Element ist zu lang",
  deep: "zu viele Elemente liegen ineinander",
  doctype: "er hat einen Dokumenttyp, den 3MF verbietet",
};

const FEATURES: Readonly<Record<ThreeMfFeature, string>> = {
  "beam-lattice": "einem Gitter von Stäben",
  slices: "Schnitten",
  displacement: "verschobenen Dreiecken",
  booleans: "Mengenoperationen",
  volumetric: "Volumendaten",
};

export const readers = ({ count }: Pick<Format, "count">) =>
  ({
    "threemf-no-directory": () => "Die 3MF-Datei ist beschädigt oder abgeschnitten: Ihr Verzeichnis fehlt; kopieren oder exportieren Sie sie noch einmal.",
    "threemf-no-part": ({ part }) => `Der 3MF-Datei fehlt der Teil ${part}; exportieren Sie das Modell noch einmal.`,
    "threemf-damaged-part": ({ part }) => `Der Teil ${part} der 3MF-Datei ist beschädigt; kopieren oder exportieren Sie sie noch einmal.`,
    "threemf-packed": ({ part, method }) =>
      `Der Teil ${part} der 3MF-Datei ist mit Verfahren ${count(method)} gepackt, verschlüsselt oder nicht; 3MF kennt 0 und 8; exportieren Sie das Modell noch einmal.`,
    "threemf-too-large": ({ part, most_bytes }) =>
      `Der Teil ${part} der 3MF-Datei wird entpackt größer als ${count(most_bytes)} Byte, zu viel für seine Größe; exportieren Sie das Modell noch einmal.`,
    "threemf-xml": ({ part, line, fault }) => `${part}, Zeile ${count(line)}: ${XML[fault]}; exportieren Sie das Modell noch einmal.`,
    "threemf-bad-attribute": ({ part, line, attribute, found }) =>
      `${part}, Zeile ${count(line)}: \`${found}\` ist kein Wert für ${attribute}; exportieren Sie das Modell noch einmal.`,
    "threemf-no-vertex": ({ part, line, vertex, vertices }) =>
      `${part}, Zeile ${count(line)}: Es gibt keine Ecke ${count(vertex)}: Das Netz hat ${count(vertices)}, ab 0; exportieren Sie das Modell noch einmal.`,
    "threemf-no-object": ({ part, line, object }) =>
      `${part}, Zeile ${count(line)}: Es gibt kein Objekt ${count(object)}; exportieren Sie das Modell noch einmal.`,
    "threemf-nested": ({ part, line, object, most_levels }) =>
      `${part}, Zeile ${count(line)}: Objekt ${count(object)} liegt mehr als ${count(most_levels)} Ebenen tief oder ist ein Teil seiner selbst; exportieren Sie das Modell noch einmal.`,
    "threemf-too-many": ({ most_facets }) =>
      `Die Objekte der 3MF-Datei wiederholen einander zu mehr als ${count(most_facets)} Dreiecken; drucken Sie weniger Kopien.`,
    "threemf-overflow": ({ part, object }) => `${part}: Die Koordinaten von Objekt ${count(object)} sind zu groß zum Rechnen; exportieren Sie das Modell noch einmal.`,
    "threemf-feature": ({ part, object, feature }) =>
      `${part}: Objekt ${count(object)} besteht aus ${FEATURES[feature]}, die Cusp nicht liest; exportieren Sie das Modell als Netz.`,
    "threemf-encrypted": ({ part }) => `${part}: Das Modell ist verschlüsselt; exportieren Sie es unverschlüsselt.`,
    "threemf-extension": ({ part, extension }) =>
      `${part}: Das Modell verlangt die Erweiterung ${extension}, die Cusp nicht kennt; exportieren Sie es ohne sie.`,
    "threemf-no-facets": ({ skipped }) =>
      `Die 3MF-Datei hat keine Dreiecke zu drucken: ${count(skipped)} ihrer Objekte sind Stützen, Flächen oder nicht zum Drucken; exportieren Sie das Modell noch einmal.`,
    "obj-bad-vertex": ({ line, found }) =>
      `Zeile ${count(line)}: Eine Ecke braucht drei endliche Zahlen und hat \`${found}\`; exportieren Sie das Modell noch einmal.`,
    "obj-bad-corner": ({ line, found, vertices }) =>
      `Zeile ${count(line)}: \`${found}\` ist nicht die Nummer einer Ecke: Die Datei hat ${count(vertices)}; exportieren Sie das Modell noch einmal.`,
    "obj-few-corners": ({ line, corners }) =>
      `Zeile ${count(line)}: Eine Fläche braucht mindestens drei Ecken und hat ${count(corners)}; exportieren Sie das Modell noch einmal.`,
    "obj-free-form": ({ line, keyword }) =>
      `Zeile ${count(line)}: \`${keyword}\` ist eine Freiformfläche ohne Dreiecke; exportieren Sie das Modell als Polygone.`,
    "obj-too-many": ({ line, most_facets }) =>
      `Zeile ${count(line)}: Die Flächen ergeben mehr als ${count(most_facets)} Dreiecke, zu viele für die Größe der Datei; exportieren Sie das Modell noch einmal.`,
    "obj-no-faces": () => "Das OBJ enthält keine Flächen; exportieren Sie das Modell noch einmal.",
  }) satisfies Partial<ErrorSentences>;
