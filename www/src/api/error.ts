/** Failures as data: a code for programs, a sentence for people, and typed details. */
import type { CoreError } from "../../pkg/cusp_slicer.js";

/** Every code that {@link SlicerError} can have, and what it means. A code once published keeps its meaning. */
export const ERROR_CODES = {
  "stl-empty": "The file has no bytes.",
  "stl-not-stl": "Neither a binary STL nor text that begins with `solid`.",
  "other-file-kind": "A file of another kind, which `detail.kind` names.",
  "stl-truncated": "The file ends before its facets do.",
  "stl-wrong-facet-count": "A binary STL with more facets than its header announces.",
  "stl-not-finite": "A coordinate is NaN or infinite.",
  "stl-syntax": "A line of a text STL that does not belong there.",
  "stl-no-facets": "A well-formed STL without facets.",
  "mesh-no-area": "No facet has an area.",
  "mesh-zero-height": "The model is flat.",
  "mesh-overflow": "Coordinates are too large to be computed with.",
  "bad-height": "The height asked for is no positive number.",
  "bad-rotation": "The rotation is no quaternion.",
  "bad-length": "A length among the options is no positive number.",
  "bad-time": "A time among the options is no number of seconds from 0.",
  "bad-options": "The options are not of their type, or one is unknown.",
  "unknown-printer": "No printer has this name; `detail.known` lists those there are.",
  "pixels-without-pitch": "Pixels and their pitch belong together.",
  "bad-antialias": "There is no such level of anti-aliasing.",
  "bad-weight-min": "The least weight is not from 0 to 1.",
  "several-targets": "More than one of tolerance, number of layers and time is given.",
  "printer-layers": "The printer cannot make layers of a thickness that the options allow.",
  "printer-step": "The motor step is no whole number of the printer's own.",
  "grid-bad-size": "Masks of no pixels, or of more than there can be.",
  "grid-too-fine": "Anti-aliasing asks for more rays than there can be.",
  "model-too-large": "The model is wider or deeper than the printer; `detail.fitting_scale` fits.",
  "model-too-high": "The model is higher than the printer's volume; `detail.fitting_scale` fits.",
  "too-many-bins": "The bins are too small for the model's height.",
  "not-whole-bins": "A length is no whole number of bins or motor steps.",
  "layer-range-empty": "No layer thickness lies in the range.",
  "layer-too-thick": "A uniform layer is thicker than the model allows.",
  "layers-do-not-fit": "Layers do not add up to the height between two planes.",
  "bad-range": "Height ranges overlap or are upside down.",
  "bad-plane": "A plane that does not lie within the model.",
  infeasible: "No plan keeps the tolerance; `detail` says where, and what would do.",
  "out-of-reach": "No plan has so few layers or so short a print.",
  "no-layer": "The plan has no such layer.",
  "no-plan": "Masks or a print file were asked for before there was a plan.",
  "no-hits": "No pixel meets the model.",
  "too-many-facets": "More facets than can be sliced.",
  "out-of-memory": "The work does not fit into memory.",
  "no-gpu": "The GPU was asked for, and there is none.",
  "gpu-too-small": "The model does not fit into the GPU's buffers.",
  "gpu-failed": "The GPU failed at work.",
  "all-black": "No pixel of any mask is lit.",
  "uniform-only": "The format has one thickness for all layers, and the plan has several.",
  "weights-not-weights": "The file holds no weights of facets.",
  "weights-other-mesh": "The weights are of another mesh.",
  "weights-out-of-range": "A weight does not lie between 0 and 1.",
  "search-directions": "An orientation search of no directions, or of too many.",
  "search-alpha": "The weight of the cost in an orientation search is not from 0 to 1.",
  "search-task": "An orientation search was given the result of a task that is not out.",
  "search-candidate": "An orientation search was given a candidate that was not measured for its direction.",
  "archive-write": "The print file could not be written.",
  cancelled: "Stopped by the core itself; an aborted call rejects with an `AbortError` instead.",
  "bad-attribute": "An attribute or property of the element makes no sense; `detail` has `attribute`, `value` and, where there is a list, `known`.",
  "no-model": "A plan or a figure was asked for before a model was loaded.",
  "file-unreadable": "The bytes of the file could not be read.",
  "fetch-failed": "The model's address did not answer with a file.",
  "start-failed": "The worker or the WebAssembly module could not be started.",
  "part-failed": "A part of the element, which `detail.part` names, could not be loaded; what is on show stays.",
  "no-browser": "There is no browser, such as on a server: nothing can be sliced there.",
  crash: "The worker broke down; the next call starts another.",
} as const satisfies Record<ErrorCode, string>;

/** Errors that only this side gives, with their details. */
interface OwnDetails {
  "bad-attribute": { attribute: string; value: unknown; known?: readonly string[] };
  "part-failed": { part: string };
  "no-browser": null;
  "no-model": null;
  "file-unreadable": null;
  "fetch-failed": { status: number } | null;
  "start-failed": null;
  crash: null;
}

type DetailOf<E> = E extends { detail: infer Detail } ? Detail : null;

/** The details of each code. Lengths are in mm. */
export type ErrorDetails = { [E in CoreError as E["code"]]: DetailOf<E> } & OwnDetails;

export type ErrorCode = keyof ErrorDetails;

export function isErrorCode(code: string): code is ErrorCode {
  return Object.hasOwn(ERROR_CODES, code);
}

/** One kind of error: its code tells what its details are. */
interface SlicerErrorOf<Code extends ErrorCode> extends Error {
  readonly name: "SlicerError";
  readonly code: Code;
  /** Typed details of the code, such as `least_tolerance`; null where there are none. */
  readonly detail: ErrorDetails[Code];
}

/**
 * What every call rejects with, except for an abort, which is the signal's reason. A union over all codes: after
 * `error.code === "infeasible"`, `error.detail.least_tolerance` is known to be there.
 */
export type SlicerError = { [Code in ErrorCode]: SlicerErrorOf<Code> }[ErrorCode];

interface SlicerErrorConstructor {
  new <Code extends ErrorCode>(
    code: Code,
    message: string,
    ...detail: null extends ErrorDetails[Code] ? [detail?: ErrorDetails[Code]] : [detail: ErrorDetails[Code]]
  ): SlicerErrorOf<Code> & SlicerError;
  readonly prototype: SlicerError;
}

export const SlicerError = class SlicerError extends Error {
  readonly code: ErrorCode;
  readonly detail: unknown;

  constructor(code: ErrorCode, message: string, detail: unknown = null) {
    super(message);
    this.name = "SlicerError";
    this.code = code;
    this.detail = detail;
  }
} as unknown as SlicerErrorConstructor;

/** Whether a call was stopped: by its `signal` for whatever reason, or by one that timed out or was aborted. */
export function isAbort(error: unknown, signal?: AbortSignal): boolean {
  if (signal?.aborted === true && error === signal.reason) return true;
  return error instanceof DOMException && (error.name === "AbortError" || error.name === "TimeoutError");
}

/** What the core threw, if it is an error that it describes: it crosses to this side as a plain object. */
export function ofCore(value: unknown): SlicerError | null {
  if (value instanceof SlicerError) return value;
  if (typeof value !== "object" || value === null || value instanceof Error) return null;
  const { code, message, detail } = value as Record<string, unknown>;
  if (typeof code !== "string" || typeof message !== "string") return null;
  const described = isErrorCode(code) ? { code, detail: detail ?? null } : { code: "crash" as const, detail: null };
  // What the core says of itself is what its types say.
  return new SlicerError(described.code as "crash", message, described.detail as null);
}

/** Anything that was thrown as one of these errors; what nobody described means that something broke. */
export function asSlicerError(error: unknown): SlicerError {
  if (error instanceof SlicerError) return error;
  return new SlicerError("crash", error instanceof Error ? error.message : String(error));
}
