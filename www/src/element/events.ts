/** The events that the element fires for its page. They bubble, and cross the shadow roots around the element. */
import type { SlicerError } from "../api/error.js";
import type { Check, Model, Plan, PrintFile } from "../api/index.js";
import type { Candidate, Price, Stage } from "../api/wire.js";

export interface ProgressDetail {
  task: "open" | "plan" | "export" | "towers" | "orient";
  stage: Stage;
  /** 0 to 1 within the stage. */
  fraction: number;
  /** 0 to 1 within the task. */
  done: number;
  /** Estimated seconds left; null while too early to estimate. */
  left_s: number | null;
}

export interface ChangeDetail {
  /** The settings as a URL query; see the property `query`. */
  query: string;
}

export interface Painted {
  /** Importance of each facet, 0 to 1; null: all equal. */
  weights: Float32Array | null;
  /** False during a brush stroke. */
  final: boolean;
}

export interface CuspSlicerEvents {
  /** A model was read. */
  "cusp-load": CustomEvent<Model>;
  /** A plan is ready: that of the plate on show. */
  "cusp-plan": CustomEvent<Plan>;
  /** The plan was priced by the property `prices`. */
  "cusp-price": CustomEvent<Price>;
  /** A plan was checked for printing faults: while a panel shows the findings, or if the property `limits` is set. */
  "cusp-check": CustomEvent<Check>;
  /** A task advanced: its stage, the fractions of stage and task, and the seconds left. */
  "cusp-progress": CustomEvent<ProgressDetail>;
  /** The download button was pressed. Cancelable: `preventDefault()` keeps the browser from saving the print file. */
  "cusp-export": CustomEvent<PrintFile>;
  /** An operation failed. The element also shows the error, except a `bad-attribute`, which concerns the page's developer. */
  "cusp-error": CustomEvent<SlicerError>;
  /** The user or a script changed the weights. */
  "cusp-paint": CustomEvent<Painted>;
  /** The user chose one of the orientations that a search found; its plan follows. */
  "cusp-orientation": CustomEvent<Candidate>;
  /** The user or a script changed the settings. */
  "cusp-change": CustomEvent<ChangeDetail>;
}
