/** What a session is given: whom it tells, what it works with, and what it begins with. */
import type { SlicerError } from "../../api/error.js";
import type { Model, Slicer } from "../../api/index.js";
import type { Backend, Candidate } from "../../api/wire.js";
import type { Busy } from "../parts/progress.js";
import type { Result } from "./result.js";
import type { Settings } from "./settings.js";

/** What a session tells its host, besides that something changed. */
export interface Host {
  requestUpdate(): void;
  loaded?(model: Model): void;
  planned?(result: Result): void;
  failed?(error: SlicerError): void;
  cancelled?(): void;
  progressed?(busy: Busy): void;
  settingsChanged?(settings: Settings): void;
  /** There is more to choose from. */
  offered?(): void;
  painted?(weights: Float32Array | null, isFinal: boolean): void;
  oriented?(candidate: Candidate): void;
}

export interface Setup {
  settings?: Settings;
  backend?: Backend | null;
}

export type SlicerCalls = Pick<
  Slicer,
  "load" | "plan" | "orient" | "mask" | "export" | "tradeoff" | "preview" | "printers" | "warm" | "setWeights" | "weightsFile" | "readWeights"
>;

/** A file to save. */
export interface Download {
  name: string;
  blob: Blob;
}
