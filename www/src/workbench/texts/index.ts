/** The texts of the workbench around the panels, one catalogue per language. */
import type { Verdict } from "../../api/wire.js";
import { Catalogues } from "../../texts/catalogues.js";
import type { Format, Language, LanguageCode } from "../../texts/index.js";
import type { HandTool, Step } from "../places.js";
import { words as en } from "./en.js";

export interface WorkbenchWords {
  /** Label of the buttons for sheets other than steps. */
  choices: string;
  /** Label of the row of tabs. */
  answers: string;
  mask: string;
  result: string;
  /** Label of the button that opens the sheet with the result. */
  more: string;
  /** Label of the slider next to the view. */
  layer: string;
  /** Exposure of a layer of this thickness. */
  exposure: (seconds: string, thickness: string) => string;
  /** Label of the row of steps. */
  path: string;
  steps: Readonly<Record<Step, string>>;
  /** Purpose of each step. */
  hints: Readonly<Record<Step, string>>;
  back: string;
  next: (step: string) => string;
  /** Labels of buttons that activate a tool of the view. */
  byHand: Readonly<Record<HandTool, string>>;
  /** Replaces features that a slicer for filament printers has itself. */
  filament: string;
  /** Progress of each step in a few words. */
  states: {
    asFile: string;
    turned: string;
    unchecked: string;
    verdicts: Readonly<Record<Verdict, string>>;
    solid: string;
    walls: (thickness: string) => string;
    supports: (strength: string, points: number, format: Format) => string;
    /** Number of points that no support reaches. */
    missing: (points: number, format: Format) => string;
    /** A field of the step is invalid. */
    wrong: string;
  };
}

const catalogues = new Catalogues<WorkbenchWords>(en, {
  de: () => import("./de.js"),
  es: () => import("./es.js"),
  fr: () => import("./fr.js"),
  zh: () => import("./zh.js"),
});

/** The page waits for this before it shows the workbench in another language. */
export function fetchWorkbenchWords(code: LanguageCode): Promise<void> {
  return catalogues.fetch(code);
}

export function workbenchWords({ code }: Language): WorkbenchWords {
  return catalogues.of(code);
}
