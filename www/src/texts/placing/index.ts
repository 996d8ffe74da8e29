/** Texts for placing support points and drain holes, one catalogue per language, fetched with their panel. */
import type { Language, LanguageCode } from "../index.js";
import { placing as de } from "./de.js";
import { placing as en } from "./en.js";
import { placing as es } from "./es.js";
import { placing as fr } from "./fr.js";
import { placing as zh } from "./zh.js";

/** Texts about support points or drain holes. */
export interface KindTexts {
  title: string;
  /** Instructions in one sentence. */
  hint: string;
  /** Label of the number that no support reaches, or that meet no void. */
  unreached: string;
  /** Number and height of the selected one. */
  selected: (number: string, all: string, height: string) => string;
  /** Replaces `selected` if none is. */
  none: string;
  /** Explains the lock. */
  lockHint: string;
}

export interface PlacingTexts {
  points: KindTexts;
  drains: KindTexts;
  /** Label of the number placed automatically. */
  automatic: string;
  /** Label of the number placed by hand, which stay. */
  byHand: string;
  diameter: string;
  /** Diameter of new holes. */
  newDiameter: string;
  lock: string;
  remove: string;
  /** Label of the switch by which automatic supports and drain holes avoid large painted weights. */
  protect: string;
  /** Explains that it applies to both, and needs painted weights. */
  protectHint: string;
  /** Label of the button that saves plugs for the holes. */
  plugs: string;
  /** Explains the use of plugs. */
  plugsHint: string;
  automatically: string;
  clear: string;
}

const CATALOGUES: Readonly<Record<LanguageCode, PlacingTexts>> = { de, en, es, fr, zh };

export const placingTexts = ({ code }: Language): PlacingTexts => CATALOGUES[code];
