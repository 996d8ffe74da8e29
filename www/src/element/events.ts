/** What an element tells its page. None of these events bubbles out of a shadow root of the page's own. */
import type { SlicerError } from "../api/error.js";
import type { Model, Plan, PrintFile } from "../api/index.js";
import type { Candidate, Stage } from "../api/wire.js";

export interface ProgressDetail {
  task: "open" | "plan" | "export" | "orient";
  stage: Stage;
  /** 0 to 1 within the stage. */
  fraction: number;
  /** 0 to 1 within the task. */
  done: number;
  /** Seconds that the task will yet take; null where nobody can know. */
  left_s: number | null;
}

export interface ChangeDetail {
  /** The settings as the query of an address: see the property `query`. */
  query: string;
}

export interface Painted {
  /** How much each facet matters, 0 to 1; null: all alike. */
  weights: Float32Array | null;
  /** False while a stroke of the brush goes on. */
  final: boolean;
}

export interface CuspSlicerEvents {
  /** A model was read. */
  "cusp-load": CustomEvent<Model>;
  /** There is a new plan. */
  "cusp-plan": CustomEvent<Plan>;
  "cusp-progress": CustomEvent<ProgressDetail>;
  /** A print file was asked for by its button. Unless this is prevented, the browser saves it. */
  "cusp-export": CustomEvent<PrintFile>;
  /** Something failed; the element shows it as well, unless it is a `bad-attribute`, which is for the page's developer. */
  "cusp-error": CustomEvent<SlicerError>;
  /** A person or a program changed how much facets matter. */
  "cusp-paint": CustomEvent<Painted>;
  /** A person chose a direction to build in; the plan follows. */
  "cusp-orientation": CustomEvent<Candidate>;
  /** A person or a program changed the settings. */
  "cusp-change": CustomEvent<ChangeDetail>;
}
