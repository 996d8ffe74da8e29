/** The texts of the workbench around the panels, one catalogue per language. */
import type { Language, LanguageCode } from "../../texts/index.js";
import { words as de } from "./de.js";
import { words as en } from "./en.js";
import { words as es } from "./es.js";
import { words as fr } from "./fr.js";
import { words as zh } from "./zh.js";

export interface WorkbenchWords {
  /** Names of the two rows of tabs. */
  choices: string;
  answers: string;
  mask: string;
  result: string;
  /** Opens the sheet with the result. */
  more: string;
  /** Names the slider beside the view. */
  layer: string;
  /** Exposure of a layer of a thickness. */
  exposure: (seconds: string, thickness: string) => string;
}

const CATALOGUES: Readonly<Record<LanguageCode, WorkbenchWords>> = { de, en, es, fr, zh };

export function workbenchWords({ code }: Language): WorkbenchWords {
  return CATALOGUES[code];
}
