import type { Format } from "../../texts/format.js";
import type { ErrorSentences, FaultSentences, FindingSentences, PrintWords } from "./index.js";

const LAYERS = { one: "Schicht", other: "Schichten" };
const KNOWN = "GOO, PRZ, unverschlüsseltes CTB, Dateien von Anycubic, NanoDLP, SL1, UVJ oder ein Zip mit Masken";

export const words = ({ count, counted }: Format): PrintWords => ({
  region: "Druckdatei",
  back: "Schließen",
  another: "Andere Datei öffnen",
  reading: (name) => `${name} wird gelesen`,
  cancel: "Abbrechen",
  whole: "Die Datei ist vollständig: Jede Schicht lässt sich lesen, und die Höhen steigen von der Platte an.",
  warnings: (number) => (number === 1 ? "Ein Hinweis" : `${count(number)} Hinweise`),
  facts: {
    format: "Format",
    software: "Geschrieben von",
    printer: "Drucker",
    plate: "Bauraum",
    masks: "Masken",
    layers: "Schichten",
    height: "Höhe",
    exposure: "Belichtung",
    bottom: "Bodenschichten",
    time: "Druckzeit",
    resin: "Harz",
  },
  pixels: (width, height, side) => `${width} × ${height} Pixel zu ${side}`,
  mirrored: "gespiegelt",
  thickness: (layers, range) => `${counted(layers, LAYERS)} zu ${range}`,
  ignored: "der Drucker beachtet die Werte einzelner Schichten nicht",
  range: (least, greatest) => `${least} bis ${greatest}`,
  bottomOf: (layers, exposure) => `${count(layers)} zu je ${exposure}`,
  stated: (stated, lit) => `${stated} laut Datei, ${lit} laut Masken`,
  lit: (lit) => `${lit} laut Masken`,
  preview: "Vorschaubild in der Datei",
  layer: (layer, exposure, lit) => `Schicht ${count(layer)}: ${[exposure, lit].filter((it) => it !== "").join(", ")}`,
  exposed: (exposure) => `${exposure} belichtet`,
  pixelsLit: (pixels) => counted(pixels, { one: "heller Pixel", other: "helle Pixel" }),
  damaged: "Diese Schicht lässt sich nicht lesen.",
  rough: "Die 3D-Ansicht ist gröber als der Druck.",
  noSurface: "Für die 3D-Ansicht hat dieser Druck zu viele Einzelheiten.",
});

export const faults = ({ count }: Format): FaultSentences => ({
  "missing-mask": ({ name }) => `${name} fehlt`,
  "bad-mask": ({ name, system }) => `${name} ist beschädigt (${system})`,
  "mask-size": ({ name, width, height, columns, rows }) =>
    `${name} hat ${width} × ${height} Pixel, laut Einstellungen wären es ${columns} × ${rows}`,
  "outside-file": ({ end_byte, file_bytes }) => `ihre Daten enden bei Byte ${count(end_byte)}, die Datei bei Byte ${count(file_bytes)}`,
  "bad-run": ({ byte }) => `Byte ${count(byte)} ihrer Daten ist keine Folge von Pixeln`,
  "too-few-pixels": ({ pixels, expected }) => `ihre Daten füllen ${count(pixels)} von ${count(expected)} Pixeln`,
  "too-many-pixels": ({ expected }) => `ihre Daten füllen mehr als ${count(expected)} Pixel`,
  "wrong-checksum": ({ stated, computed }) => `ihre Prüfsumme ist ${stated}, die ihrer Daten ${computed}`,
});

export const findings = ({ count, counted, mm, height }: Format): FindingSentences => ({
  "no-layers": () => "Die Datei hat keine Schichten; zerlegen Sie das Modell noch einmal.",
  "bad-heights": ({ layers, first_layer }) =>
    `${counted(layers, { one: "Schicht endet", other: "Schichten enden" })} bei einer Höhe, die keine Zahl ist, zuerst Schicht ${count(first_layer)}; exportieren Sie die Datei neu.`,
  "bad-exposures": ({ layers, first_layer }) =>
    `${counted(layers, { one: "Schicht hat", other: "Schichten haben" })} eine Belichtung, die keine Zahl ist, zuerst Schicht ${count(first_layer)}; prüfen Sie die Belichtungen und exportieren Sie die Datei neu.`,
  "bad-nominal-values": () =>
    "Die Schichtdicke oder eine Belichtung für alle Schichten ist keine Zahl; prüfen Sie die Einstellungen und exportieren Sie die Datei neu.",
  "first-layer-below-plate": ({ z_mm }) =>
    `Die erste Schicht endet bei ${mm(z_mm)}, also nicht über der Platte; zerlegen Sie das Modell noch einmal.`,
  "heights-not-ascending": ({ layers, first_layer, z_mm, below_mm }) =>
    `${counted(layers, { one: "Schicht liegt", other: "Schichten liegen" })} nicht über der vorigen, zuerst Schicht ${count(first_layer)} bei ${mm(z_mm)} nach ${mm(below_mm)}; zerlegen Sie das Modell noch einmal.`,
  "ignored-heights": ({ thinnest_mm, thickest_mm, layer_mm }) =>
    `Die Schichten sind ${mm(thinnest_mm)} bis ${mm(thickest_mm)} dick, doch laut Datei soll der Drucker das nicht beachten` +
    `${layer_mm === null ? "" : ` und um je ${mm(layer_mm)} steigen`}; exportieren Sie sie mit Werten für jede Schicht, oder nehmen Sie Schichten einer Dicke.`,
  "no-exposure": ({ layers, first_layer }) =>
    `${counted(layers, { one: "Schicht hat", other: "Schichten haben" })} keine Belichtung, zuerst Schicht ${count(first_layer)}; prüfen Sie die Belichtungen und exportieren Sie die Datei neu.`,
  "black-layers": ({ layers, first_layer, from_mm }) =>
    `${counted(layers, { one: "Schicht ist", other: "Schichten sind" })} schwarz, zuerst Schicht ${count(first_layer)} ab ${height(from_mm)}: Dort wird nichts gedruckt; sehen Sie sich die Masken an.`,
  "bad-layers": ({ layers, first_layer }, fault) =>
    `${counted(layers, { one: "Schicht ist", other: "Schichten sind" })} beschädigt, zuerst Schicht ${count(first_layer)}: ${fault}; kopieren oder exportieren Sie die Datei noch einmal.`,
  "missing-marks": ({ layers, first_layer }) =>
    `Bei ${counted(layers, { one: "Schicht", other: "Schichten" })} fehlen am Ende die Bytes 0D 0A, zuerst bei Schicht ${count(first_layer)}; kopieren oder exportieren Sie die Datei noch einmal.`,
  "missing-end": () => "Die Datei endet nicht, wie sie soll; kopieren Sie sie noch einmal, vielleicht ist sie abgeschnitten.",
  "bad-preview": ({ preview }) =>
    `Vorschaubild ${count(preview)} ist beschädigt; der Bildschirm des Druckers zeigt vielleicht Rauschen, der Druck leidet nicht.`,
});

export const errors = ({ count }: Format): ErrorSentences => ({
  "unknown-kind": () => `Das ist keine lesbare Druckdatei; öffnen Sie ${KNOWN}.`,
  "damaged-zip": ({ system }) => `Das Zip ist beschädigt (${system}); kopieren oder exportieren Sie es noch einmal.`,
  "unknown-zip": () => `Dieses Zip enthält keine Einstellungen eines bekannten Formats, wie run.gcode oder manifest.json; öffnen Sie ${KNOWN}.`,
  model: ({ has_layers }) =>
    has_layers
      ? "Diese 3MF ist ein Modell mit Schichten für Slicer von Filamentdruckern und hat keine Masken; öffnen Sie sie in jenem Slicer, oder öffnen Sie sie hier als Modell und schneiden Sie es für einen Harzdrucker."
      : "Diese 3MF ist ein Modell und hat keine Masken; öffnen Sie sie als Modell und schneiden Sie es.",
  "encrypted-ctb": () =>
    "Diese CTB-Datei ist verschlüsselt und ohne den Schlüssel des Herstellers nicht lesbar; speichern Sie sie als unverschlüsseltes CTB, als GOO oder als Zip mit Masken.",
  unread: ({ kind }) =>
    ({
      cbddlp: "Das ist eine cbddlp- oder photon-Datei der ersten ChiTuBox-Drucker, die sich nicht lesen lässt; speichern Sie sie als unverschlüsseltes CTB oder als GOO.",
      "planes-of-bits": "Diese Datei von Photon Workshop speichert je Graustufe eine Bitebene und lässt sich nicht lesen; speichern Sie sie als GOO oder als Zip mit Masken.",
      outlines: "Dieses Zip von Anycubic enthält Umrisse statt Masken und lässt sich nicht lesen; speichern Sie es als GOO oder als Zip mit Masken.",
    })[kind],
  "unknown-version": ({ version, known }) => `Version ${version} dieses Formats lässt sich nicht lesen; speichern Sie die Datei als Version ${known}.`,
  truncated: ({ needed_bytes, found_bytes }) =>
    `Die Datei ist abgeschnitten: Ihre Einstellungen brauchen ${count(needed_bytes)} Byte, sie hat ${count(found_bytes)}; kopieren oder exportieren Sie sie noch einmal.`,
  "too-many-layers": ({ layers, most }) =>
    `Die Datei meldet ${count(layers)} Schichten und hat Platz für höchstens ${count(most)}; kopieren oder exportieren Sie sie noch einmal.`,
  "missing-file": ({ name }) => `Im Zip fehlt ${name}, worauf sich die Einstellungen verlassen; exportieren Sie es noch einmal.`,
  "bad-file": ({ name, system }) => `${name} lässt sich nicht lesen (${system}); exportieren Sie die Datei noch einmal.`,
  "too-large": ({ name, most_bytes }) => `${name} ist ausgepackt größer als ${count(most_bytes)} Byte; exportieren Sie die Datei noch einmal.`,
  "bad-setting": ({ file, setting }) => `${file} sagt nicht lesbar, was ${setting} ist; exportieren Sie die Datei noch einmal.`,
  "too-many-pixels": ({ width, height, max_side }) =>
    `Die Masken haben ${count(width)} × ${count(height)} Pixel, möglich sind ${count(max_side)} je Seite.`,
  layer: ({ layer }, fault) => `Schicht ${count(layer)} lässt sich nicht lesen: ${fault}; exportieren Sie die Datei noch einmal.`,
  "file-unreadable": () => "Die Datei lässt sich nicht lesen. Wurde sie verschoben oder gelöscht? Wählen Sie sie noch einmal.",
  crash: ({ system }) => `Das Lesen brach unerwartet ab (${system}). Versuchen Sie es noch einmal.`,
});
