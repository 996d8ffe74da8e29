/** Failures: a heading, an explanation, and advice if no plan keeps the tolerance. */
import type { Format } from "../format.js";
import { errors } from "./errors.js";

export const problems = (format: Format) => ({
  /** A heading for each kind of failure; the sentence below it is that of the failure's code. */
  headings: {
    notModel: (name: string) => `${name} is not a model that Cusp reads`,
    empty: (name: string) => `${name} is empty`,
    cutShort: (name: string) => `${name} is cut short`,
    damaged: (name: string) => `${name} is damaged`,
    unusable: (name: string) => `${name} cannot be sliced`,
    tooLarge: () => "The model is too large for this printer",
    plate: () => "The plate cannot be printed like this",
    tooHigh: () => "The model is too high for this printer",
    tooFine: () => "This resolution is too much for this computer",
    noHits: (name: string) => `${name} is too thin for these pixels`,
    allBlack: () => "Every layer would be empty",
    layerTooThick: () => "The layers are too thick for this model",
    rangeEmpty: () => "No layer of whole motor steps lies in this range",
    doNotFit: () => "These layers do not add up to the model’s height",
    notWhole: () => "These lengths do not go together",
    infeasible: () => "No plan keeps the tolerance all the way up",
    badRange: () => "These height ranges do not go together",
    badPlane: () => "There can be no plane at this height",
    badValue: () => "A value is out of bounds",
    badOptions: () => "These settings do not go together",
    noSuchPrinter: () => "There is no such printer",
    badPrinter: () => "This printer’s description has an error",
    outOfReach: () => "No plan is as short as that",
    gpu: () => "The GPU could not be used",
    gpuTooSmall: () => "The GPU is too small for this model",
    uniformOnly: () => "This print file takes uniform layers only",
    printerUniformOnly: () => "This printer takes uniform layers only",
    unreadable: (name: string) => `${name} could not be opened`,
    notFetched: (name: string) => `${name} could not be fetched`,
    startFailed: () => "The slicer could not be started",
    crash: () => "The slicer stopped",
    notWeights: (name: string) => `${name} holds no weights`,
    otherMesh: (name: string) => `${name} is of another model`,
    other: () => "That did not work",
  } satisfies Headings,
  /** Advice if no plan keeps the tolerance. */
  infeasible: {
    either: "Raise the tolerance, or allow thinner layers if your printer can make them.",
    larger: "Raise the tolerance.",
    thinner: "Allow thinner layers if your printer can make them.",
    neither: "Change the range of layers.",
  },
  errors: errors(format),
});

export type ProblemTexts = ReturnType<typeof problems>;

type Headings = Record<string, (name: string) => string>;
