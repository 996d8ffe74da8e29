/** Failures, what would mend them, and warnings. */
import type { Format } from "../format.js";
import { LAYERS, FACETS, EDGES, HOLES } from "./nouns.js";

export const problems = ({ counted }: Format) => ({
  offers: {
    tolerance: (error: string) => `Tolerance ${error}`,
    layersFrom: (thickness: string) => `Layers from ${thickness}`,
    rays: (count: string) => `${count} rays`,
    scale: (height: string) => `Scale to ${height}`,
    uniform: (thickness: string) => `Uniform layers of ${thickness}`,
    images: "Save as images",
    noPrinter: "Without a printer",
    again: "Try again",
  },
  /** For each kind of failure a heading and what to do. `message` is the core's own sentence, which is English. */
  problems: {
    notStl: (name: string) => [
      `${name} is not an STL file`,
      "Cusp reads binary and text STL files: export your model as STL and drop that.",
    ],
    empty: (name: string, message: string) => [`${name} is empty`, message],
    cutShort: (name: string, message: string) => [`${name} is cut short`, message],
    damaged: (name: string, message: string) => [
      `${name} is damaged`,
      `${message} Export the model again as STL and drop the new file.`,
    ],
    unusable: (name: string, message: string) => [`${name} cannot be sliced`, message],
    tooLarge: (_name: string, message: string) => ["The model is too large for this printer", message],
    tooHigh: (_name: string, message: string) => ["The model is too high for this printer", message],
    tooFine: (_name: string, message: string) => ["This resolution is too much for this computer", message],
    noHits: (name: string, message: string) => [`${name} is too thin for these pixels`, message],
    allBlack: (_name: string, message: string) => ["Every mask would be black", message],
    layerTooThick: (_name: string, message: string) => ["The layers are too thick for this model", message],
    rangeEmpty: (_name: string, message: string) => ["No layer of whole motor steps lies in this range", message],
    doNotFit: (_name: string, message: string) => ["These layers do not add up to the model’s height", message],
    notWhole: (_name: string, message: string) => ["These lengths do not go together", message],
    badRange: (_name: string, message: string) => ["These height ranges do not go together", message],
    badPlane: (_name: string, message: string) => ["There can be no plane at this height", message],
    badTime: (_name: string, message: string) => ["These times make no sense", message],
    badOptions: (_name: string, message: string) => ["These settings do not go together", message],
    outOfReach: (_name: string, message: string) => ["No plan is as short as that", message],
    gpu: (_name: string, message: string) => ["The GPU could not be used", message],
    gpuTooSmall: (_name: string, message: string) => ["The GPU is too small for this model", message],
    uniformOnly: (_name: string, _message: string) => [
      "This print file takes uniform layers only",
      "It has one thickness for all layers, and this plan has several.",
    ],
    unreadable: (name: string, _message: string) => [
      `${name} could not be opened`,
      "It may have been moved, changed or locked. Choose it again.",
    ],
    notFetched: (name: string, message: string) => [`${name} could not be fetched`, message],
    startFailed: (_name: string, message: string) => [
      "The slicer could not be started",
      `Reload the page. If that does not help, this browser may be too old for WebAssembly. (${message})`,
    ],
    crash: (_name: string, message: string) => [
      "The slicer stopped",
      `It may have run out of memory. It has been started afresh: try again, with fewer rays if the model is large. (${message})`,
    ],
    notWeights: (name: string, _message: string) => [`${name} holds no weights`, "Choose a file of weights that was saved for this model."],
    otherMesh: (name: string, _message: string) => [`${name} is of another model`, "Choose a file of weights that was saved for this model."],
    other: (_name: string, message: string) => ["That did not work", message],
  } satisfies Problems,
  infeasible: {
    title: (tolerance: string) => `No plan keeps ${tolerance} all the way up`,
    where: (from: string, to: string, thinnest: string) =>
      `From ${from} to ${to} even a layer of ${thinnest}, the thinnest allowed, leaves a larger error.`,
    either: "Allow a larger error, or thinner layers if your printer can make them.",
    larger: "Allow a larger error.",
    thinner: "Allow thinner layers if your printer can make them.",
    neither: "Change the range of layers.",
  },
  /** A file that is no STL: `kind` is what it is called, such as 3MF. */
  otherKind: {
    title: (name: string, kind: string) => `${name} is a file of another kind: ${kind}`,
    model: "Cusp reads STL. Export the model as STL, and open that.",
    packed: "Unpack it, and open the STL inside.",
    page: "This is a web page, not a model. Download the model itself: the address may need a login, or lead to a page about it.",
  },
  /** By the code of a warning; figures come as text, already written for the language, except where a plural depends on them. */
  warnings: {
    "degenerate-facets": (facets: number) => `${counted(facets, FACETS)} without area left out.`,
    "inside-out": () => "The mesh was inside out, and was turned over.",
    "open-mesh": (edges: number, holes: number) =>
      `The mesh is not closed: ${counted(edges, EDGES)} without a partner, ${counted(holes, HOLES)} closed by flat caps. Look at the masks.`,
    "unclosed-rays": (unclosed: string, rays: string) =>
      `${unclosed} of ${rays} rays pass holes of the mesh; flat caps close them. Look at the masks.`,
    "tolerance-exceeded": (error: string, tolerance: string) => `The error reaches ${error}, more than the tolerance of ${tolerance}.`,
    "tolerance-exceeded-on-mesh": (error: string, tolerance: string) =>
      `On the mesh itself the error reaches ${error}, more than the tolerance of ${tolerance}: rays miss a part of the surface.`,
    "sampled-sections": () => "The surface crosses itself, so that areas of sections are counted along rays.",
    "top-moved": (top: string, height: string) => `The print ends at ${top}, since layers do not add up to ${height}.`,
    "black-layers": (layers: number, from: string) =>
      `${counted(layers, LAYERS)} without a lit pixel, from ${from} up: parts hang in the air, or are thinner than a pixel. Look at the masks there.`,
    "gpu-too-small": () => "The model does not fit into the GPU’s memory; the CPU did its work.",
    "gpu-failed": (reason: string) => `The GPU failed, and the CPU did its work. (${reason})`,
  },
});

export type ProblemTexts = ReturnType<typeof problems>;

/** A heading, and a sentence or two. */
export type Words = readonly [title: string, text: string];

type Problems = Record<string, (name: string, message: string) => [string, string]>;
