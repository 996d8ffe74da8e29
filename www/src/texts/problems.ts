/** Failures: a heading, an explanation, and advice if no plan keeps the tolerance. Long and rarely needed, so fetched with the first failure. */
import type { ErrorCode, ErrorDetails } from "../api/error.js";
import type { Metric } from "../api/wire.js";
import { sayer } from "./codes.js";
import { errorCases, errorNames, errors } from "./errors.js";
import { room, type Spoken } from "./messages.js";
import "./nouns.js";

export const problemTexts = room("", {
  /** A heading for each kind of failure; the sentence below it is that of the failure's code. */
  headings: {
    empty: "{name} is empty",
    cutShort: "{name} is cut short",
    damaged: "{name} is damaged",
    unusable: "{name} cannot be sliced",
    tooLarge: "The model is too large for this printer",
    plate: "The plate cannot be printed like this",
    tooHigh: "The model is too high for this printer",
    tooFine: "This resolution is too much for this computer",
    floats: "Pieces of the print would float in the vat",
    noHits: "{name} is too thin for these pixels",
    allBlack: "Every layer would be empty",
    layerTooThick: "The layers are too thick for this model",
    rangeEmpty: "No layer of whole motor steps lies in this range",
    doNotFit: "These layers do not add up to the model’s height",
    notWhole: "These lengths do not go together",
    infeasible: "No plan keeps the tolerance all the way up",
    badRange: "These height ranges do not go together",
    badPlane: "There can be no plane at this height",
    badValue: "A value is out of bounds",
    badOptions: "These settings do not go together",
    noSuchPrinter: "There is no such printer",
    badPrinter: "This printer’s description has an error",
    outOfReach: "No plan meets this limit",
    gpu: "The GPU could not be used",
    gpuTooSmall: "The GPU is too small for this model",
    uniformOnly: "This print file takes uniform layers only",
    printerUniformOnly: "This printer takes uniform layers only",
    unreadable: "{name} could not be opened",
    notFetched: "{name} could not be fetched",
    startFailed: "The slicer could not be started",
    crash: "The slicer stopped",
    notWeights: "{name} holds no weights",
    otherMesh: "{name} is of another model",
    other: "That did not work",
  },
  /** Advice if no plan keeps the tolerance. */
  infeasible: {
    either: "Raise the tolerance, or allow thinner layers if your printer can make them.",
    larger: "Raise the tolerance.",
    thinner: "Allow thinner layers if your printer can make them.",
    neither: "Change the range of layers.",
  },
  errors,
  names: errorNames,
});

const sayError = sayer<typeof errors, ErrorDetails>("errors", errorCases);

/** Sentence about a failure. `metric` is that of tolerances without a unit. */
export function errorOf<Code extends ErrorCode>(code: Code, detail: ErrorDetails[Code], metric: Metric, language: Spoken): string {
  return sayError(code, detail, language, { metric });
}
