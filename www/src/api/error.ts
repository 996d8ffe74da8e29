/** Failures as data: a code for programs, a sentence for people, and typed details. */
import type { CoreError } from "../../pkg/cusp_slicer.js";

/** Errors that only this side gives, with their details. Like the core's, a code once published keeps its meaning. */
interface OwnDetails {
  /** An attribute or property of the element makes no sense; where there is a list, `known` is what there is. */
  "bad-attribute": { attribute: string; value: unknown; known?: readonly string[] };
  /** A plan or a figure was asked for before a model was loaded. */
  "no-model": null;
  /** The bytes of the file could not be read. */
  "file-unreadable": null;
  /** The model's address did not answer with a file, or not at all. */
  "fetch-failed": { status: number } | SystemDetail;
  /** The worker or the WebAssembly module could not be started. */
  "start-failed": SystemDetail;
  /** A part of the element could not be loaded; what is on show stays. */
  "part-failed": SystemDetail & { part: string };
  /** There is no browser, such as on a server: nothing can be sliced there. */
  "no-browser": null;
  /** The worker broke down; the next call starts another. */
  crash: SystemDetail;
}

/** What the browser, the network or the worker said, untranslated. */
interface SystemDetail {
  system: string;
}

type DetailOf<E> = E extends { detail: infer Detail } ? (Detail extends undefined ? null : Detail) : null;

/** Every code with its details. Lengths are in mm. The core's are generated from its own types. */
export type ErrorDetails = { [E in CoreError as E["code"]]: DetailOf<E> } & OwnDetails;

export type ErrorCode = keyof ErrorDetails;

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
  // What the core throws is what its types say.
  return new SlicerError(code as "no-plan", message, (detail ?? null) as null);
}

/** Anything that was thrown as one of these errors; what nobody described means that something broke. */
export function asSlicerError(error: unknown): SlicerError {
  if (error instanceof SlicerError) return error;
  const system = said(error);
  return new SlicerError("crash", system, { system });
}

/** What an error that nobody described says of itself. */
export const said = (error: unknown): string => (error instanceof Error ? error.message : String(error));
