/** What a session is given: its host, the slicer that it calls, and its initial settings. */
import type { SlicerError } from "../../api/error.js";
import type { Check, Model, Slicer } from "../../api/index.js";
import type { Backend, Candidate, Price } from "../../api/wire.js";
import type { Busy } from "../parts/progress.js";
import type { Result } from "./result.js";
import type { ModelCalls } from "./selected.js";
import type { Settings } from "./settings.js";
import type { SyncCalls } from "./sync.js";

/** What a session reports to its host. */
export interface Host {
  requestUpdate(): void;
  /** Returns true if it shows the model. */
  hasView?(): boolean;
  loaded?(model: Model): void;
  planned?(result: Result): void;
  failed?(error: SlicerError): void;
  /** A plan was checked for what will fail. */
  checked?(check: Check): void;
  /** A plan could not be checked; it stays. */
  unchecked?(error: SlicerError): void;
  cancelled?(): void;
  progressed?(busy: Busy): void;
  settingsChanged?(settings: Settings): void;
  /** The list of printers has arrived. */
  offered?(): void;
  painted?(weights: Float32Array | null, isFinal: boolean): void;
  oriented?(candidate: Candidate): void;
  priced?(price: Price): void;
  /** The page's prices cannot be used. */
  mispriced?(error: SlicerError): void;
}

export interface Setup {
  settings?: Settings;
  backend?: Backend | null;
}

export type SlicerCalls = Pick<
  Slicer,
  "plan" | "problems" | "mask" | "check" | "export" | "calibrateLayers" | "tradeoff" | "price" | "printers" | "warm"
> &
  SyncCalls &
  ModelCalls;

/** A file to save. */
export interface Download {
  name: string;
  blob: Blob;
}
