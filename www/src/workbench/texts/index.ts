/** The texts of the workbench around the panels, one catalogue per language. */
import type { Verdict } from "../../api/wire.js";
import { Catalogues } from "../../texts/catalogues.js";
import type { Format, Language, LanguageCode } from "../../texts/index.js";
import type { HandTool, Step } from "../places.js";
import { words as en } from "./en.js";

export interface WorkbenchWords {
  /** Names the buttons of the sheets that are no steps. */
  choices: string;
  /** Names the row of tabs. */
  answers: string;
  mask: string;
  result: string;
  /** Opens the sheet with the result. */
  more: string;
  /** Names the slider beside the view. */
  layer: string;
  /** Exposure of a layer of a thickness. */
  exposure: (seconds: string, thickness: string) => string;
  /** Names the row of steps. */
  path: string;
  steps: Readonly<Record<Step, string>>;
  /** What each step is for. */
  hints: Readonly<Record<Step, string>>;
  back: string;
  next: (step: string) => string;
  /** Take up a tool of the view. */
  byHand: Readonly<Record<HandTool, string>>;
  /** In place of what a slicer of a filament printer does itself. */
  filament: string;
  /** How far each step is, in a few words. */
  states: {
    asFile: string;
    turned: string;
    unchecked: string;
    verdicts: Readonly<Record<Verdict, string>>;
    solid: string;
    walls: (thickness: string) => string;
    supports: (strength: string, points: number, format: Format) => string;
    /** Of points that no support reaches. */
    missing: (points: number, format: Format) => string;
    /** A field of the step cannot be as it is. */
    wrong: string;
  };
}

const catalogues = new Catalogues<WorkbenchWords>(en, {
  de: () => import("./de.js"),
  es: () => import("./es.js"),
  fr: () => import("./fr.js"),
  zh: () => import("./zh.js"),
});

/** The page waits for it before it shows the workbench in a language. */
export function fetchWorkbenchWords(code: LanguageCode): Promise<void> {
  return catalogues.fetch(code);
}

export function workbenchWords({ code }: Language): WorkbenchWords {
  return catalogues.of(code);
}
