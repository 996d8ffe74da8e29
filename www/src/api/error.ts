/** Errors as data: a code for programs, a sentence for people, and typed details. */
import type { CoreError } from "../../pkg/cusp_slicer.js";
import { visible } from "./visible.js";

/** Errors raised outside the core, with their details. A published code keeps its meaning. */
interface OwnDetails {
  /** An attribute or property of the element is invalid; `known` lists the valid names, if there is a list. */
  "bad-attribute": { attribute: string; value: unknown; known?: readonly string[] };
  /** A call that needs a model was made before one was loaded. */
  "no-model": null;
  /** The bytes of the file could not be read. */
  "file-unreadable": null;
  /** A value of this type is not a source of a model. */
  "bad-source": { given: string };
  /** The length of `positions` or `indices` is not a multiple of `multiple_of`. */
  "bad-facets": { list: "positions" | "indices"; numbers: number; multiple_of: number };
  /** An index of a source refers to no vertex. */
  "bad-index": { place: number; index: number; vertices: number };
  /** An argument is not a whole number from 0. */
  "bad-number": { argument: string; value: unknown };
  /** A link to a file was dropped, not the file itself. */
  "dropped-link": null;
  /** A folder without any model was dropped. */
  "folder-without-model": null;
  /** The printer description is not a JSON object. */
  "printer-not-json": SystemDetail;
  /** The printer description is longer than `most_bytes`. */
  "printer-too-long": { bytes: number; most_bytes: number };
  /** The model's URL returned an HTTP error, or could not be reached. */
  "fetch-failed": { status: number } | SystemDetail;
  /** The worker could not be started: its script is missing or unreachable, or blocked by the page's policy or the browser. */
  "worker-failed": SystemDetail;
  /** The WebAssembly module could not be started. */
  "start-failed": SystemDetail;
  /** A part of the element that is fetched when first shown could not be loaded; the rest of the element stays. */
  "part-failed": SystemDetail & { part: string };
  /** There is no browser, as on a server: nothing can be sliced. */
  "no-browser": null;
  /** The worker crashed; the next call starts another. */
  crash: SystemDetail;
}

/** The message of the browser, the network or the worker, untranslated. */
interface SystemDetail {
  system: string;
}

type DetailOf<E> = E extends { detail: infer Detail } ? (Detail extends undefined ? null : Detail) : null;

/** Every code with its details. Lengths are in mm. Those of the core are generated from its types. */
export type ErrorDetails = { [E in CoreError as E["code"]]: DetailOf<E> } & OwnDetails;

export type ErrorCode = keyof ErrorDetails;

/** An error whose code determines the type of its details. */
interface SlicerErrorOf<Code extends ErrorCode> extends Error {
  readonly name: "SlicerError";
  readonly code: Code;
  /** Details of the code, such as `least_tolerance`; null if it has none. */
  readonly detail: ErrorDetails[Code];
}

/**
 * Error with which every call rejects, except on an abort, which rejects with the signal's reason. A union over all codes: after
 * `error.code === "infeasible"`, TypeScript knows `error.detail.least_tolerance`.
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

/** Returns true if an error is an abort: the reason of `signal`, or any `AbortError` or `TimeoutError`. */
export function isAbort(error: unknown, signal?: AbortSignal): boolean {
  if (signal?.aborted === true && error === signal.reason) return true;
  return error instanceof DOMException && (error.name === "AbortError" || error.name === "TimeoutError");
}

/** Converts an error that crossed from the core as a plain object; null for any other value. */
export function ofCore(value: unknown): SlicerError | null {
  if (value instanceof SlicerError) return value;
  if (typeof value !== "object" || value === null || value instanceof Error) return null;
  const { code, message, detail } = value as Record<string, unknown>;
  if (typeof code !== "string" || typeof message !== "string") return null;
  // The core's types tie the detail to the code.
  return new SlicerError(code as "no-plan", visible(message) as string, visible(detail ?? null) as null);
}

/** Any thrown value as a `SlicerError`; an unknown one becomes a `crash`. */
export function asSlicerError(error: unknown): SlicerError {
  if (error instanceof SlicerError) return error;
  const system = said(error);
  return new SlicerError("crash", system, { system });
}

/** The message of any thrown value. */
export const said = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** Throws `bad-number` unless an argument is a whole number from 0: the core would read 1.5 as 1, and NaN as 0. */
export function checkWhole(argument: string, value: unknown): void {
  if (Number.isInteger(value) && (value as number) >= 0) return;
  throw new SlicerError("bad-number", `${argument} must be a whole number from 0, not ${String(value)}`, { argument, value });
}
