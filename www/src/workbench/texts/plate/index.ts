/** The texts of the list of models, one catalogue per language, fetched with the list. */
import type { Language, LanguageCode } from "../../../texts/index.js";
import { words as de } from "./de.js";
import { words as en } from "./en.js";
import { words as es } from "./es.js";
import { words as fr } from "./fr.js";
import { words as zh } from "./zh.js";

export interface PlateWords {
  title: string;
  remove: (name: string) => string;
  spacing: string;
  /** Names the choice of turns about z. */
  turns: string;
  turnless: string;
  step: (degrees: string) => string;
  plate: (number: string, count: string) => string;
  previous: string;
  next: string;
  /** A copy's share of time and resin. */
  each: (time: string, resin: string) => string;
  /** Time and resin of all plates. */
  whole: (time: string, resin: string) => string;
  all: string;
  /** Copies are not where they were arranged. */
  moved: string;
}

const CATALOGUES: Readonly<Record<LanguageCode, PlateWords>> = { de, en, es, fr, zh };

export function plateWords({ code }: Language): PlateWords {
  return CATALOGUES[code];
}
