/** Interfaces of a session: its host, the slicer that it calls, and its initial settings. */
import type { SlicerError } from "../../api/error.js";
import type { Check, Model, Slicer } from "../../api/index.js";
import type { Backend, Candidate, Price } from "../../api/wire.js";
import type { Busy } from "../parts/progress.js";
import type { Result } from "./result.js";
import type { ModelCalls } from "./selected.js";
import type { Settings } from "./settings.js";
import type { SyncCalls } from "./sync.js";

/** Callbacks of a session to its host. */
export interface Host {
  requestUpdate(): void;
  /** Returns true if the host shows the model. */
  hasView?(): boolean;
  loaded?(model: Model): void;
  planned?(result: Result): void;
  failed?(error: SlicerError): void;
  /** Called when a plan has been checked. */
  checked?(check: Check): void;
  /** Called when a plan could not be checked; the plan stays. */
  unchecked?(error: SlicerError): void;
  cancelled?(): void;
  progressed?(busy: Busy): void;
  settingsChanged?(settings: Settings): void;
  /** Called when the list of printers has arrived. */
  offered?(): void;
  painted?(weights: Float32Array | null, isFinal: boolean): void;
  oriented?(candidate: Candidate): void;
  priced?(price: Price): void;
  /** Called if the page's prices are invalid. */
  mispriced?(error: SlicerError): void;
}

export interface Setup {
  settings?: Settings;
  backend?: Backend | null;
}

export type SlicerCalls = Pick<
  Slicer,
  "plan" | "problems" | "mask" | "check" | "export" | "calibrateLayers" | "calibrateCure" | "fitCure" | "tradeoff" | "price" | "printers" | "readProject" | "writeProject" | "warm"
> &
  SyncCalls &
  ModelCalls;

/** A file to save. */
export interface Download {
  name: string;
  blob: Blob;
}
