/** Texts of the findings, one catalogue per language, fetched with their panel. */
import type { Code, Finding, Printability, Severity } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { Language, LanguageCode } from "../index.js";
import { findings as de } from "./de.js";
import { findings as en } from "./en.js";
import { findings as es } from "./es.js";
import { findings as fr } from "./fr.js";
import { findings as zh } from "./zh.js";

/** Formatted figures of a finding. */
export interface Said {
  readonly area: string;
  readonly volume: string;
  /** The volume as an amount of resin. */
  readonly resin: string;
  /** The limit with its unit. */
  readonly limit: string;
  /** First layer, counted from 1. */
  readonly first: string;
  readonly joins: string;
  /** Number of layers. */
  readonly layers: number;
}

export interface FindingsTexts {
  checking: string;
  /** Shown if there are no findings. */
  none: string;
  verdicts: Readonly<Record<Printability["verdict"], string>>;
  severities: Readonly<Record<Severity, string>>;
  kinds: Readonly<Record<Code, string>>;
  /** Explanation of each kind. */
  sentences: Readonly<Record<Code, (said: Said) => string>>;
  /** Advice on each kind. */
  advice: Readonly<Record<Code, string>>;
  layers: (first: string, last: string) => string;
  layer: (number: string) => string;
  /** Label of the button that shows all findings of a kind. */
  all: (count: string) => string;
  /** Number of smaller findings of a kind that are not listed. */
  smaller: (count: string) => string;
  /** Explains the effect of choosing a finding. */
  hint: string;
  /** Label of the switch that colours the model by wall thickness. */
  walls: string;
  /** Explains the colours and the marked areas. */
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

/** Formats a figure with four significant digits. */
const figure = (value: number, format: Format): string => format.exact(Number(value.toPrecision(4)));

function limitOf(code: Code, limit: number, format: Format): string {
  if (code === "small-contact") return format.percent(limit, 1);
  return code === "peel-area" || code === "peel-jump" ? `${format.exact(limit)}\u00a0mm²` : format.mm(limit);
}
