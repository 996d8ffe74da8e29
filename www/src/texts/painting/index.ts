/** Texts for painting weights, one catalogue per language, fetched with their panel. */
import type { Language, LanguageCode } from "../index.js";
import { painting as de } from "./de.js";
import { painting as en } from "./en.js";
import { painting as es } from "./es.js";
import { painting as fr } from "./fr.js";
import { painting as zh } from "./zh.js";

export type PaintingTexts = typeof en;

const CATALOGUES: Readonly<Record<LanguageCode, PaintingTexts>> = { de, en, es, fr, zh };

export const paintingTexts = ({ code }: Language): PaintingTexts => CATALOGUES[code];
