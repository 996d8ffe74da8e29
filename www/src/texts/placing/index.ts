/** The texts for placing support points and drain holes, one catalogue per language. They are fetched with their panel. */
import type { Language, LanguageCode } from "../index.js";
import { placing as de } from "./de.js";
import { placing as en } from "./en.js";
import { placing as es } from "./es.js";
import { placing as fr } from "./fr.js";
import { placing as zh } from "./zh.js";

/** What is said of points, and of holes. */
export interface KindTexts {
  title: string;
  /** What to do, in one sentence. */
  hint: string;
  /** How many no support gets to, or meet no void. */
  unreached: string;
  /** Which of them is selected, and how high it is. */
  selected: (number: string, all: string, height: string) => string;
  /** Instead of that, if none is. */
  none: string;
  /** What a lock does. */
  lockHint: string;
}

export interface PlacingTexts {
  points: KindTexts;
  drains: KindTexts;
  /** How many are placed automatically. */
  automatic: string;
  /** How many are placed by hand, and stay. */
  byHand: string;
  diameter: string;
  /** Diameter of the holes that are added. */
  newDiameter: string;
  lock: string;
  remove: string;
  /** Where weights are painted, automatic supports and drain holes keep off the largest ones. */
  spare: string;
  /** That it is for both, and why it has no effect yet. */
  spareHint: string;
  /** The button that saves plugs for the holes. */
  plugs: string;
  /** What to do with them. */
  plugsHint: string;
  automatically: string;
  clear: string;
}

const CATALOGUES: Readonly<Record<LanguageCode, PlacingTexts>> = { de, en, es, fr, zh };

export const placingTexts = ({ code }: Language): PlacingTexts => CATALOGUES[code];
