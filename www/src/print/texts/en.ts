import type { Format } from "../../texts/format.js";
import type { ErrorSentences, FaultSentences, FindingSentences, PrintWords } from "./index.js";

const LAYERS = { one: "layer", other: "layers" };
const ARE = { one: "layer is", other: "layers are" };
const HAVE = { one: "layer has", other: "layers have" };
const KNOWN = "GOO, PRZ, plain CTB, Anycubic's files, NanoDLP, SL1, UVJ, or a zip of masks";

export const words = ({ count, counted }: Format): PrintWords => ({
  region: "Print file",
  back: "Close",
  another: "Open another file",
  reading: (name) => `Reading ${name}`,
  cancel: "Cancel",
  whole: "The file is whole: every layer can be read, and heights rise from the plate.",
  warnings: (number) => (number === 1 ? "One thing to look at" : `${count(number)} things to look at`),
  facts: {
    format: "Format",
    software: "Written by",
    printer: "Printer",
    plate: "Build volume",
    masks: "Masks",
    layers: "Layers",
    height: "Height",
    exposure: "Exposure",
    bottom: "Bottom layers",
    time: "Print time",
    resin: "Resin",
  },
  pixels: (width, height, side) => `${width} × ${height} pixels of ${side}`,
  mirrored: "mirrored",
  thickness: (layers, range) => `${counted(layers, LAYERS)} of ${range}`,
  ignored: "the printer ignores the values of single layers",
  range: (least, greatest) => `${least} to ${greatest}`,
  bottomOf: (layers, exposure) => `${count(layers)}, ${exposure} each`,
  stated: (stated, lit) => `${stated} by the file, ${lit} by the masks`,
  lit: (lit) => `${lit} by the masks`,
  preview: "Preview in the file",
  layer: (layer, exposure, lit) => `Layer ${count(layer)}: ${[exposure, lit].filter((it) => it !== "").join(", ")}`,
  exposed: (exposure) => `exposed for ${exposure}`,
  pixelsLit: (pixels) => `${count(pixels)} pixels lit`,
  damaged: "This layer cannot be read.",
  rough: "The 3-D view is coarser than the print.",
  noSurface: "This print has too much detail for the 3-D view.",
});

export const faults = ({ count }: Format): FaultSentences => ({
  "missing-mask": ({ name }) => `there is no ${name}`,
  "bad-mask": ({ name, system }) => `${name} is damaged (${system})`,
  "mask-size": ({ name, width, height, columns, rows }) =>
    `${name} is ${width} × ${height} pixels, and the settings ask for ${columns} × ${rows}`,
  "outside-file": ({ end_byte, file_bytes }) => `its data ends at byte ${count(end_byte)}, and the file at byte ${count(file_bytes)}`,
  "bad-run": ({ byte }) => `byte ${count(byte)} of its data is no run of pixels`,
  "too-few-pixels": ({ pixels, expected }) => `its runs cover ${count(pixels)} of ${count(expected)} pixels`,
  "too-many-pixels": ({ expected }) => `its runs cover more than ${count(expected)} pixels`,
  "wrong-checksum": ({ stated, computed }) => `its checksum is ${stated}, and that of its data ${computed}`,
});

export const findings = ({ count, counted, mm, height }: Format): FindingSentences => ({
  "no-layers": () => "The file has no layers; slice the model again.",
  "bad-heights": ({ layers, first_layer }) =>
    `${counted(layers, { one: "layer ends", other: "layers end" })} at a height that is no number, first layer ${count(first_layer)}; export the file again.`,
  "bad-exposures": ({ layers, first_layer }) =>
    `${counted(layers, HAVE)} an exposure that is no number, first layer ${count(first_layer)}; check the exposures and export the file again.`,
  "bad-nominal-values": () =>
    "The layer thickness or an exposure for all layers is no number; check the settings and export the file again.",
  "first-layer-below-plate": ({ z_mm }) => `The first layer ends at ${mm(z_mm)}, not above the plate; slice the model again.`,
  "heights-not-ascending": ({ layers, first_layer, z_mm, below_mm }) =>
    `${counted(layers, { one: "layer ends", other: "layers end" })} not above the layer below, first layer ${count(first_layer)}, at ${mm(z_mm)} after ${mm(below_mm)}; slice the model again.`,
  "ignored-heights": ({ thinnest_mm, thickest_mm, layer_mm }) =>
    `Layers are ${mm(thinnest_mm)} to ${mm(thickest_mm)} thick, but the file tells the printer to ignore that` +
    `${layer_mm === null ? "" : ` and to rise by ${mm(layer_mm)}`}; export it with values for each layer, or slice with layers of one thickness.`,
  "no-exposure": ({ layers, first_layer }) =>
    `${counted(layers, HAVE)} no exposure, first layer ${count(first_layer)}; check the exposures and export the file again.`,
  "black-layers": ({ layers, first_layer, from_mm }) =>
    `${counted(layers, ARE)} black, first layer ${count(first_layer)}, from ${height(from_mm)} up: nothing is printed there; look at the masks.`,
  "bad-layers": ({ layers, first_layer }, fault) =>
    `${counted(layers, ARE)} damaged, first layer ${count(first_layer)}: ${fault}; copy or export the file again.`,
  "missing-marks": ({ layers, first_layer }) =>
    `${counted(layers, ARE)} not closed by the bytes 0D 0A, first layer ${count(first_layer)}; copy or export the file again.`,
  "missing-end": () => "The file does not end as it should; copy it again, it may be cut short.",
  "bad-preview": ({ preview }) =>
    `Preview ${count(preview)} is damaged; the printer's screen may show noise, the print is not affected.`,
});

export const errors = ({ count }: Format): ErrorSentences => ({
  "unknown-kind": () => `This is no print file that can be read; open ${KNOWN}.`,
  "damaged-zip": ({ system }) => `The zip is damaged (${system}); copy or export it again.`,
  "unknown-zip": () => `This zip has no settings of a known format, such as run.gcode or manifest.json; open ${KNOWN}.`,
  model: ({ has_layers }) =>
    has_layers
      ? "This 3MF is a model with layers for slicers of filament printers and has no masks; open it in that slicer, or open it here as a model and slice it for a resin printer."
      : "This 3MF is a model and has no masks; open it as a model and slice it.",
  "encrypted-ctb": () =>
    "This CTB file is encrypted and cannot be read without its maker's key; save it again as plain CTB, as GOO or as a zip of masks.",
  unread: ({ kind }) =>
    ({
      cbddlp: "This is a cbddlp or photon file of the first ChiTuBox printers, which cannot be read; save it again as plain CTB or GOO.",
      "planes-of-bits": "This Photon Workshop file has a plane of bits for each grey, which cannot be read; save it again as GOO or a zip of masks.",
      outlines: "This Anycubic zip has outlines instead of masks, which cannot be read; save it again as GOO or a zip of masks.",
    })[kind],
  "unknown-version": ({ version, known }) => `Version ${version} of this format cannot be read; save it again as version ${known}.`,
  truncated: ({ needed_bytes, found_bytes }) =>
    `The file is cut short: its settings need ${count(needed_bytes)} bytes, and it has ${count(found_bytes)}; copy or export it again.`,
  "too-many-layers": ({ layers, most }) =>
    `The file declares ${count(layers)} layers and has room for ${count(most)} at most; copy or export it again.`,
  "missing-file": ({ name }) => `The zip has no ${name}, although its settings count on it; export it again.`,
  "bad-file": ({ name, system }) => `${name} cannot be read (${system}); export the file again.`,
  "too-large": ({ name, most_bytes }) => `${name} unpacks to more than ${count(most_bytes)} bytes; export the file again.`,
  "bad-setting": ({ file, setting }) => `${file} does not say ${setting} in a form that can be read; export the file again.`,
  "too-many-pixels": ({ width, height, max_side }) =>
    `The masks are ${count(width)} × ${count(height)} pixels, and there can be ${count(max_side)} a side.`,
  layer: ({ layer }, fault) => `Layer ${count(layer)} cannot be read: ${fault}; export the file again.`,
  "file-unreadable": () => "The file cannot be read. Was it moved or deleted? Choose it again.",
  crash: ({ system }) => `Reading stopped unexpectedly (${system}). Try again.`,
});
