/** The texts of the page around the element, one catalogue per language. */
import type { Language, LanguageCode } from "../../texts/index.js";
import { words as de } from "./de.js";
import { words as en } from "./en.js";
import { words as es } from "./es.js";
import { words as fr } from "./fr.js";
import { words as zh } from "./zh.js";

export interface PageWords {
  title: string;
  tagline: string;
  private: string;
  drop: string;
  /** Names the choice of languages. */
  languages: string;
  noModel: string;
  tryExample: string;
  printFile: string;
  example: string;
  /** Buttons of the header: models that this browser keeps, named settings, the list of keys. */
  recent: string;
  saved: string;
  keys: string;
  /** What the page promises: a heading, and a sentence. */
  points: readonly (readonly [heading: string, sentence: string])[];
}

const CATALOGUES: Readonly<Record<LanguageCode, PageWords>> = { de, en, es, fr, zh };

export function pageWords({ code }: Language): PageWords {
  return CATALOGUES[code];
}
