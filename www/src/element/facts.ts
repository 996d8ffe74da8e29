/** The input of a layout: state and actions of the element. */
import type { LitElement } from "lit";
import type { Slicer } from "../api/index.js";
import type { Language } from "../texts/index.js";
import type { Panel } from "./state/panel-names.js";
import type { Problem } from "./state/problem.js";
import type { Session } from "./state/session.js";

export interface Facts {
  element: LitElement;
  session: Session;
  language: Language;
  /** The session's failure, explained; null if there is none. */
  problem: Problem | null;
  panels: ReadonlySet<Panel>;
  slicer: Slicer;
  isDragging: boolean;
  picked(event: Event): void;
  /** Adds the chosen files to the open model. */
  added(event: Event): void;
  save(): void;
  /** Saves the print files of all plates. */
  saveAll(): void;
  saveTowers(): void;
  saveBridges(): void;
  saveWeights(): void;
}
