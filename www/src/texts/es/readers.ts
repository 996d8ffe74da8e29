import type { ThreeMfFeature, XmlFault } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { ErrorSentences } from "../sentences.js";

const XML: Readonly<Record<XmlFault, string>> = {
  "cut-short": "termina antes que sus elementos",
  "not-xml": "no es XML en UTF-8",
  "wrong-end-tag": "una etiqueta de cierre no corresponde a la de apertura",
  attribute: "un atributo no es un nombre y un valor entre comillas",
  "long-tag": "una etiqueta es demasiado larga",
  deep: "hay demasiados elementos unos dentro de otros",
  doctype: "tiene un tipo de documento, que 3MF prohíbe",
};

const FEATURES: Readonly<Record<ThreeMfFeature, string>> = {
  "beam-lattice": "una celosía de barras",
  slices: "cortes",
  displacement: "facetas desplazadas",
  booleans: "operaciones booleanas",
  volumetric: "datos volumétricos",
};

export const readers = ({ count }: Pick<Format, "count">) =>
  ({
    "threemf-no-directory": () => "El archivo 3MF está dañado o cortado: falta su directorio; cópielo o expórtelo de nuevo.",
    "threemf-no-part": ({ part }) => `Al archivo 3MF le falta la parte ${part}; exporte el modelo de nuevo.`,
    "threemf-damaged-part": ({ part }) => `La parte ${part} del archivo 3MF está dañada; cópielo o expórtelo de nuevo.`,
    "threemf-packed": ({ part, method }) =>
      `La parte ${part} del archivo 3MF está comprimida con el método ${count(method)}, cifrada o no; 3MF conoce 0 y 8; exporte el modelo de nuevo.`,
    "threemf-too-large": ({ part, most_bytes }) =>
      `La parte ${part} del archivo 3MF descomprimida pasa de ${count(most_bytes)} bytes, demasiado para su tamaño; exporte el modelo de nuevo.`,
    "threemf-xml": ({ part, line, fault }) => `${part}, línea ${count(line)}: ${XML[fault]}; exporte el modelo de nuevo.`,
    "threemf-bad-attribute": ({ part, line, attribute, found }) =>
      `${part}, línea ${count(line)}: \`${found}\` no es un valor de ${attribute}; exporte el modelo de nuevo.`,
    "threemf-no-vertex": ({ part, line, vertex, vertices }) =>
      `${part}, línea ${count(line)}: no hay vértice ${count(vertex)}: la malla tiene ${count(vertices)}, desde 0; exporte el modelo de nuevo.`,
    "threemf-no-object": ({ part, line, object }) =>
      `${part}, línea ${count(line)}: no hay objeto ${count(object)}; exporte el modelo de nuevo.`,
    "threemf-nested": ({ part, line, object, most_levels }) =>
      `${part}, línea ${count(line)}: el objeto ${count(object)} está a más de ${count(most_levels)} niveles, o es parte de sí mismo; exporte el modelo de nuevo.`,
    "threemf-too-many": ({ most_facets }) =>
      `Los objetos del archivo 3MF se repiten hasta más de ${count(most_facets)} facetas; imprima menos copias.`,
    "threemf-overflow": ({ part, object }) => `${part}: las coordenadas del objeto ${count(object)} son demasiado grandes para calcular; exporte el modelo de nuevo.`,
    "threemf-feature": ({ part, object, feature }) =>
      `${part}: el objeto ${count(object)} consiste en ${FEATURES[feature]}, que Cusp no lee; exporte el modelo como malla.`,
    "threemf-encrypted": ({ part }) => `${part}: el modelo está cifrado; expórtelo sin cifrar.`,
    "threemf-extension": ({ part, extension }) =>
      `${part}: el modelo exige la extensión ${extension}, que Cusp no conoce; expórtelo sin ella.`,
    "threemf-no-facets": ({ skipped }) =>
      `El archivo 3MF no tiene facetas que imprimir: ${count(skipped)} de sus objetos son soportes, superficies o no se imprimen; exporte el modelo de nuevo.`,
    "obj-bad-vertex": ({ line, found }) =>
      `Línea ${count(line)}: un vértice necesita tres números finitos, y tiene \`${found}\`; exporte el modelo de nuevo.`,
    "obj-bad-corner": ({ line, found, vertices }) =>
      `Línea ${count(line)}: \`${found}\` no es el número de un vértice: el archivo tiene ${count(vertices)}; exporte el modelo de nuevo.`,
    "obj-few-corners": ({ line, corners }) =>
      `Línea ${count(line)}: una cara necesita al menos tres esquinas, y tiene ${count(corners)}; exporte el modelo de nuevo.`,
    "obj-free-form": ({ line, keyword }) =>
      `Línea ${count(line)}: \`${keyword}\` es una superficie libre sin facetas; exporte el modelo como polígonos.`,
    "obj-too-many": ({ line, most_facets }) =>
      `Línea ${count(line)}: las caras suman más de ${count(most_facets)} facetas, demasiadas para el tamaño del archivo; exporte el modelo de nuevo.`,
    "obj-no-faces": () => "El OBJ no contiene caras; exporte el modelo de nuevo.",
  }) satisfies Partial<ErrorSentences>;
