/** The texts of the findings, one catalogue per language. They are fetched with their panel. */
import type { Code, Finding, Printability, Severity } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { Language, LanguageCode } from "../index.js";
import { findings as de } from "./de.js";
import { findings as en } from "./en.js";
import { findings as es } from "./es.js";
import { findings as fr } from "./fr.js";
import { findings as zh } from "./zh.js";

/** The figures of a finding, as the language writes them. */
export interface Said {
  readonly area: string;
  readonly volume: string;
  /** The volume as resin. */
  readonly resin: string;
  /** The limit with its unit. */
  readonly limit: string;
  /** Layers from 1. */
  readonly first: string;
  readonly joins: string;
  /** How many layers it has. */
  readonly layers: number;
}

export interface FindingsTexts {
  checking: string;
  /** Nothing was found. */
  none: string;
  verdicts: Readonly<Record<Printability["verdict"], string>>;
  severities: Readonly<Record<Severity, string>>;
  kinds: Readonly<Record<Code, string>>;
  /** What it is: a sentence for each kind. */
  sentences: Readonly<Record<Code, (said: Said) => string>>;
  /** What to do about it. */
  advice: Readonly<Record<Code, string>>;
  layers: (first: string, last: string) => string;
  layer: (number: string) => string;
  /** Shows all findings of a kind. */
  all: (count: string) => string;
  /** How many findings of a kind are not listed, since they are smaller. */
  smaller: (count: string) => string;
  /** What choosing a finding does. */
  hint: string;
  /** The switch that colours the model by how thick it is. */
  walls: string;
  /** What the colours are, and what is marked. */
  wallsHint: (limit: string) => string;
}

const CATALOGUES: Readonly<Record<LanguageCode, (format: Format) => FindingsTexts>> = { de, en, es, fr, zh };

export function findingsTexts({ code, format }: Language): FindingsTexts {
  return CATALOGUES[code](format);
}

export function saidOf({ code, area_mm2, volume_mm3, limit, layers: [first, last], joins_layer }: Finding, format: Format): Said {
  return {
    area: `${figure(area_mm2, format)}\u00a0mm²`,
    volume: `${figure(volume_mm3, format)}\u00a0mm³`,
    resin: format.millilitres(volume_mm3 / 1000),
    limit: limitOf(code, limit, format),
    first: format.count(first + 1),
    joins: format.count((joins_layer ?? last + 1) + 1),
    layers: last + 1 - first,
  };
}

/** To four digits. */
const figure = (value: number, format: Format): string => format.exact(Number(value.toPrecision(4)));

function limitOf(code: Code, limit: number, format: Format): string {
  if (code === "small-contact") return format.percent(limit, 1);
  return code === "peel-area" || code === "peel-jump" ? `${format.exact(limit)}\u00a0mm²` : format.mm(limit);
}
