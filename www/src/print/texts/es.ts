import type { Format } from "../../texts/format.js";
import type { ErrorSentences, FaultSentences, FindingSentences, PrintWords } from "./index.js";

const LAYERS = { one: "capa", other: "capas" };
const KNOWN = "GOO, PRZ, CTB sin cifrar, archivos de Anycubic, NanoDLP, SL1, UVJ o un zip de máscaras";

export const words = ({ count, counted }: Format): PrintWords => ({
  region: "Archivo de impresión",
  back: "Cerrar",
  another: "Abrir otro archivo",
  reading: (name) => `Leyendo ${name}`,
  cancel: "Cancelar",
  whole: "El archivo está completo: todas las capas se pueden leer y las alturas crecen desde la plataforma.",
  warnings: (number) => (number === 1 ? "Un aviso" : `${count(number)} avisos`),
  facts: {
    format: "Formato",
    software: "Escrito por",
    printer: "Impresora",
    plate: "Volumen de impresión",
    masks: "Máscaras",
    layers: "Capas",
    height: "Altura",
    exposure: "Exposición",
    bottom: "Capas de base",
    time: "Tiempo de impresión",
    resin: "Resina",
  },
  pixels: (width, height, side) => `${width} × ${height} píxeles de ${side}`,
  mirrored: "reflejadas",
  thickness: (layers, range) => `${counted(layers, LAYERS)} de ${range}`,
  ignored: "la impresora no tiene en cuenta los valores de cada capa",
  range: (least, greatest) => `${least} a ${greatest}`,
  bottomOf: (layers, exposure) => `${count(layers)}, ${exposure} cada una`,
  stated: (stated, lit) => `${stated} según el archivo, ${lit} según las máscaras`,
  lit: (lit) => `${lit} según las máscaras`,
  preview: "Vista previa del archivo",
  layer: (layer, exposure, lit) => `Capa ${count(layer)}: ${[exposure, lit].filter((it) => it !== "").join(", ")}`,
  exposed: (exposure) => `${exposure} de exposición`,
  pixelsLit: (pixels) => counted(pixels, { one: "píxel encendido", other: "píxeles encendidos" }),
  damaged: "Esta capa no se puede leer.",
  rough: "La vista 3D es más tosca que la impresión.",
  noSurface: "Esta impresión tiene demasiado detalle para la vista 3D.",
});

export const faults = ({ count }: Format): FaultSentences => ({
  "missing-mask": ({ name }) => `falta ${name}`,
  "bad-mask": ({ name, system }) => `${name} está dañado (${system})`,
  "mask-size": ({ name, width, height, columns, rows }) =>
    `${name} tiene ${width} × ${height} píxeles y los ajustes piden ${columns} × ${rows}`,
  "outside-file": ({ end_byte, file_bytes }) => `sus datos acaban en el byte ${count(end_byte)} y el archivo en el byte ${count(file_bytes)}`,
  "bad-run": ({ byte }) => `el byte ${count(byte)} de sus datos no es una serie de píxeles`,
  "too-few-pixels": ({ pixels, expected }) => `sus datos cubren ${count(pixels)} de ${count(expected)} píxeles`,
  "too-many-pixels": ({ expected }) => `sus datos cubren más de ${count(expected)} píxeles`,
  "wrong-checksum": ({ stated, computed }) => `su suma de comprobación es ${stated} y la de sus datos ${computed}`,
});

export const findings = ({ count, counted, mm, height }: Format): FindingSentences => ({
  "no-layers": () => "El archivo no tiene capas; vuelva a dividir el modelo.",
  "bad-heights": ({ layers, first_layer }) =>
    `${counted(layers, { one: "capa acaba", other: "capas acaban" })} a una altura que no es un número, la primera es la ${count(first_layer)}; exporte el archivo de nuevo.`,
  "bad-exposures": ({ layers, first_layer }) =>
    `${counted(layers, { one: "capa tiene", other: "capas tienen" })} una exposición que no es un número, la primera es la ${count(first_layer)}; revise las exposiciones y exporte el archivo de nuevo.`,
  "bad-nominal-values": () =>
    "El espesor de capa o una exposición para todas las capas no es un número; revise los ajustes y exporte el archivo de nuevo.",
  "first-layer-below-plate": ({ z_mm }) =>
    `La primera capa acaba en ${mm(z_mm)}, no por encima de la plataforma; vuelva a dividir el modelo.`,
  "heights-not-ascending": ({ layers, first_layer, z_mm, below_mm }) =>
    `${counted(layers, { one: "capa no acaba", other: "capas no acaban" })} por encima de la anterior, la primera es la ${count(first_layer)}, a ${mm(z_mm)} después de ${mm(below_mm)}; vuelva a dividir el modelo.`,
  "ignored-heights": ({ thinnest_mm, thickest_mm, layer_mm }) =>
    `Las capas tienen de ${mm(thinnest_mm)} a ${mm(thickest_mm)} de espesor, pero el archivo dice a la impresora que no lo tenga en cuenta` +
    `${layer_mm === null ? "" : ` y que suba ${mm(layer_mm)} cada vez`}; expórtelo con valores para cada capa o use capas de un solo espesor.`,
  "no-exposure": ({ layers, first_layer }) =>
    `${counted(layers, { one: "capa no tiene", other: "capas no tienen" })} exposición, la primera es la ${count(first_layer)}; revise las exposiciones y exporte el archivo de nuevo.`,
  "black-layers": ({ layers, first_layer, from_mm }) =>
    `${counted(layers, { one: "capa es negra", other: "capas son negras" })}, la primera es la ${count(first_layer)}, desde ${height(from_mm)}: ahí no se imprime nada; mire las máscaras.`,
  "bad-layers": ({ layers, first_layer }, fault) =>
    `${counted(layers, { one: "capa está dañada", other: "capas están dañadas" })}, la primera es la ${count(first_layer)}: ${fault}; copie o exporte el archivo de nuevo.`,
  "missing-marks": ({ layers, first_layer }) =>
    `A ${counted(layers, LAYERS)} les faltan los bytes finales 0D 0A, la primera es la ${count(first_layer)}; copie o exporte el archivo de nuevo.`,
  "missing-end": () => "El archivo no acaba como debe; cópielo de nuevo, puede estar cortado.",
  "bad-preview": ({ preview }) =>
    `La vista previa ${count(preview)} está dañada; la pantalla de la impresora puede mostrar ruido, pero la impresión no se ve afectada.`,
});

export const errors = ({ count }: Format): ErrorSentences => ({
  "unknown-kind": () => `No es un archivo de impresión que se pueda leer; abra ${KNOWN}.`,
  "damaged-zip": ({ system }) => `El zip está dañado (${system}); cópielo o expórtelo de nuevo.`,
  "unknown-zip": () => `Este zip no tiene los ajustes de ningún formato conocido, como run.gcode o manifest.json; abra ${KNOWN}.`,
  model: ({ has_layers }) =>
    has_layers
      ? "Este 3MF es un modelo con capas para laminadores de impresoras de filamento y no tiene máscaras; ábralo en ese laminador, o ábralo aquí como modelo y lamínelo para una impresora de resina."
      : "Este 3MF es un modelo y no tiene máscaras; ábralo como modelo y lamínelo.",
  "encrypted-ctb": () =>
    "Este archivo CTB está cifrado y no se puede leer sin la clave del fabricante; guárdelo como CTB sin cifrar, como GOO o como zip de máscaras.",
  unread: ({ kind }) =>
    ({
      cbddlp: "Es un archivo cbddlp o photon de las primeras impresoras ChiTuBox, que no se puede leer; guárdelo como CTB sin cifrar o como GOO.",
      "planes-of-bits": "Este archivo de Photon Workshop guarda un plano de bits por cada gris y no se puede leer; guárdelo como GOO o como zip de máscaras.",
      outlines: "Este zip de Anycubic tiene contornos en lugar de máscaras y no se puede leer; guárdelo como GOO o como zip de máscaras.",
    })[kind],
  "unknown-version": ({ version, known }) => `La versión ${version} de este formato no se puede leer; guárdelo como versión ${known}.`,
  truncated: ({ needed_bytes, found_bytes }) =>
    `El archivo está cortado: sus ajustes necesitan ${count(needed_bytes)} bytes y tiene ${count(found_bytes)}; cópielo o expórtelo de nuevo.`,
  "too-many-layers": ({ layers, most }) =>
    `El archivo anuncia ${count(layers)} capas y tiene sitio para ${count(most)} como mucho; cópielo o expórtelo de nuevo.`,
  "missing-file": ({ name }) => `Al zip le falta ${name}, con el que cuentan sus ajustes; expórtelo de nuevo.`,
  "bad-file": ({ name, system }) => `${name} no se puede leer (${system}); exporte el archivo de nuevo.`,
  "too-large": ({ name, most_bytes }) => `${name} ocupa más de ${count(most_bytes)} bytes al descomprimirlo; exporte el archivo de nuevo.`,
  "bad-setting": ({ file, setting }) => `${file} no indica ${setting} de forma legible; exporte el archivo de nuevo.`,
  "too-many-pixels": ({ width, height, max_side }) =>
    `Las máscaras tienen ${count(width)} × ${count(height)} píxeles y el máximo es ${count(max_side)} por lado.`,
  layer: ({ layer }, fault) => `La capa ${count(layer)} no se puede leer: ${fault}; exporte el archivo de nuevo.`,
  "file-unreadable": () => "El archivo no se puede leer. ¿Se movió o se borró? Elíjalo de nuevo.",
  crash: ({ system }) => `La lectura se interrumpió de forma inesperada (${system}). Inténtelo de nuevo.`,
});
