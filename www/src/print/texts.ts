/** Texts of the view of print files, fetched with the view. */
import type { FileFinding, LayerFault, PrintFileError } from "../../pkg/cusp_reader.js";
import { sayer, type Sentences } from "../texts/codes.js";
import { room, type Spoken } from "../texts/messages.js";
import type { ReadError } from "./open-print.js";

type Failure = PrintFileError | ReadError;
type Details<Said extends { code: string }> = { [Each in Said as Each["code"]]: Each extends { detail: infer Detail } ? Detail : null };

const words = {
  region: "Print file",
  back: "Close",
  another: "Open another file",
  reading: "Reading {name}",
  cancel: "Cancel",
  /** Label of the button that chooses the printer of the file. */
  use: "Slice for this printer",
  /** Shown if the file has no faults. */
  whole: "The file is whole: every layer can be read, and heights rise from the plate.",
  warnings: "{count|one:One thing to look at|other:# things to look at}",
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
  pixels: "{width} × {height} pixels of {side}",
  mirrored: "mirrored",
  thickness: "{layers|one:# layer|other:# layers} of {range}",
  ignored: "the printer ignores the values of single layers",
  range: "{least} to {greatest}",
  bottomOf: "{layers|count}, {exposure} each",
  stated: "{stated} by the file, {lit} by the masks",
  lit: "{lit} by the masks",
  preview: "Preview in the file",
  layer: {
    exposed: "Layer {layer|count}: {exposure}, {lit}",
    bare: "Layer {layer|count}: {lit}",
  },
  exposed: "exposed for {exposure}",
  pixelsLit: "{pixels|count} pixels lit",
  damaged: "This layer cannot be read.",
  rough: "The 3-D view is coarser than the print.",
  noSurface: "This print has too much detail for the 3-D view.",
} as const;

const faults = {
  "missing-mask": "there is no {name}",
  "bad-mask": "{name} is damaged ({system})",
  "mask-size": "{name} is {width} × {height} pixels, and the settings ask for {columns} × {rows}",
  "outside-file": "its data ends at byte {end_byte|count}, and the file at byte {file_bytes|count}",
  "bad-run": "byte {byte|count} of its data is no run of pixels",
  "too-few-pixels": "its runs cover {pixels|count} of {expected|count} pixels",
  "too-many-pixels": "its runs cover more than {expected|count} pixels",
  "wrong-checksum": "its checksum is {stated}, and that of its data {computed}",
} as const satisfies Sentences<LayerFault["code"]>;

const findings = {
  "no-layers": "The file has no layers; slice the model again.",
  "bad-heights": "{layers|one:# layer ends|other:# layers end} at a height that is not a number, starting with layer {first_layer|count}; export the file again.",
  "bad-exposures": "{layers|one:# layer has|other:# layers have} an exposure that is not a number, starting with layer {first_layer|count}; check the exposures and export the file again.",
  "bad-nominal-values": "The layer thickness or an exposure for all layers is no number; check the settings and export the file again.",
  "first-layer-below-plate": "The first layer ends at {z_mm|mm}, not above the plate; slice the model again.",
  "heights-not-ascending": "{layers|one:# layer ends|other:# layers end} no higher than the layer below, starting with layer {first_layer|count}, at {z_mm|mm} after {below_mm|mm}; slice the model again.",
  "ignored-heights": {
    bare: "Layers are {thinnest_mm|mm} to {thickest_mm|mm} thick, but the file tells the printer to ignore that; export it with values for each layer, or slice with layers of one thickness.",
    rise: "Layers are {thinnest_mm|mm} to {thickest_mm|mm} thick, but the file tells the printer to ignore that and to rise by {layer_mm|mm}; export it with values for each layer, or slice with layers of one thickness.",
  },
  "no-exposure": "{layers|one:# layer has|other:# layers have} no exposure, starting with layer {first_layer|count}; check the exposures and export the file again.",
  "black-layers": "{layers|one:# layer is|other:# layers are} black, starting with layer {first_layer|count} at {from_mm|height}: nothing is printed there; look at the masks.",
  "bad-layers": "{layers|one:# layer is|other:# layers are} damaged, starting with layer {first_layer|count}: {fault}; copy or export the file again.",
  "missing-marks": "{layers|one:# layer is|other:# layers are} not closed by the bytes 0D 0A, starting with layer {first_layer|count}; copy or export the file again.",
  "missing-end": "The file does not end as it should; copy it again, it may be cut short.",
  "bad-preview": "Preview {preview|count} is damaged; the printer's screen may show noise, the print is not affected.",
} as const satisfies Sentences<FileFinding["code"]>;

const errors = {
  "unknown-kind": "This is no print file that can be read; open GOO, PRZ, plain CTB, Anycubic's files, NanoDLP, SL1, UVJ, or a zip of masks.",
  "damaged-zip": "The zip is damaged ({system}); copy or export it again.",
  "unknown-zip": "This zip has no settings of a known format, such as run.gcode or manifest.json; open GOO, PRZ, plain CTB, Anycubic's files, NanoDLP, SL1, UVJ, or a zip of masks.",
  model: {
    layers: "This 3MF is a model with layers for slicers of filament printers and has no masks; open it in that slicer, or open it here as a model and slice it for a resin printer.",
    bare: "This 3MF is a model and has no masks; open it as a model and slice it.",
  },
  "encrypted-ctb": "This CTB file is encrypted and cannot be read without its maker's key; save it again as plain CTB, as GOO or as a zip of masks.",
  unread: {
    cbddlp: "This is a cbddlp or photon file of the first ChiTuBox printers, which cannot be read; save it again as plain CTB or GOO.",
    "planes-of-bits": "This Photon Workshop file has a plane of bits for each grey, which cannot be read; save it again as GOO or a zip of masks.",
    outlines: "This Anycubic zip has outlines instead of masks, which cannot be read; save it again as GOO or a zip of masks.",
  },
  "unknown-version": "Version {version} of this format cannot be read; save it again as version {known}.",
  truncated: "The file is cut short: its settings need {needed_bytes|count} bytes, and it has {found_bytes|count}; copy or export it again.",
  "too-many-layers": "The file declares {layers|count} layers and has room for {most|count} at most; copy or export it again.",
  "missing-file": "The zip has no {name}, although its settings count on it; export it again.",
  "bad-file": "{name} cannot be read ({system}); export the file again.",
  "too-large": "{name} unpacks to more than {most_bytes|count} bytes; export the file again.",
  "bad-setting": "{file} does not say {setting} in a form that can be read; export the file again.",
  "too-many-pixels": "The masks are {width|count} × {height|count} pixels, and there can be {max_side|count} a side.",
  layer: "Layer {layer|count} cannot be read: {fault}; export the file again.",
  "file-unreadable": "The file cannot be read. Was it moved or deleted? Choose it again.",
  crash: "Reading stopped unexpectedly ({system}). Try again.",
} as const satisfies Sentences<Failure["code"]>;

export const printTexts = room("print", { ...words, faults, findings, errors });

const sayFault = sayer<typeof faults, Details<LayerFault>>("print.faults", {});

const sayFinding = sayer<typeof findings, Details<FileFinding>>("print.findings", {
  "ignored-heights": ({ layer_mm }) => (layer_mm === null ? "bare" : "rise"),
});

const sayFailure = sayer<typeof errors, Details<Failure>>("print.errors", {
  model: ({ has_layers }) => (has_layers ? "layers" : "bare"),
  unread: ({ kind }) => kind,
});

export const findingOf = (finding: FileFinding, language: Spoken): string => sayFinding(finding.code, detailOf(finding), language, faultOf(finding, language));

export const failureOf = (failure: Failure, language: Spoken): string => sayFailure(failure.code, detailOf(failure), language, faultOf(failure, language));

const detailOf = (said: object): never => ("detail" in said ? said.detail : null) as never;

/** The fault of a layer within a sentence, if there is one. */
function faultOf(said: FileFinding | Failure, language: Spoken): object {
  const { fault } = (detailOf(said) ?? {}) as { fault?: LayerFault };
  return fault === undefined ? {} : { fault: sayFault(fault.code, fault.detail, language) };
}
