/** Texts of the view of print files, one catalogue per language, fetched with the view. */
import type { FileFinding, LayerFault, PrintFileError } from "../../../pkg/cusp_reader.js";
import type { Format } from "../../texts/format.js";
import type { Language, LanguageCode } from "../../texts/index.js";
import type { ReadError } from "../open-print.js";
import * as de from "./de.js";
import * as en from "./en.js";
import * as es from "./es.js";
import * as fr from "./fr.js";
import * as zh from "./zh.js";

export interface PrintWords {
  region: string;
  back: string;
  another: string;
  reading(name: string): string;
  cancel: string;
  /** Shown if the file has no faults. */
  whole: string;
  warnings(count: number): string;
  facts: Readonly<
    Record<
      "format" | "software" | "printer" | "plate" | "masks" | "layers" | "height" | "exposure" | "bottom" | "time" | "resin",
      string
    >
  >;
  pixels(width: string, height: string, side: string): string;
  mirrored: string;
  thickness(layers: number, range: string): string;
  ignored: string;
  range(least: string, greatest: string): string;
  bottomOf(layers: number, exposure: string): string;
  stated(stated: string, lit: string): string;
  lit(lit: string): string;
  preview: string;
  layer(layer: number, exposure: string, lit: string): string;
  exposed(exposure: string): string;
  pixelsLit(pixels: number): string;
  damaged: string;
  rough: string;
  noSurface: string;
}

type DetailOf<E> = E extends { detail: infer Detail } ? Detail : null;
type Sentences<E extends { code: string }> = { readonly [Each in E as Each["code"]]: (detail: DetailOf<Each>, fault: string) => string };

export type FaultSentences = Sentences<LayerFault>;
export type FindingSentences = Sentences<FileFinding>;
export type ErrorSentences = Sentences<PrintFileError | ReadError>;

interface Catalogue {
  words(format: Format): PrintWords;
  faults(format: Format): FaultSentences;
  findings(format: Format): FindingSentences;
  errors(format: Format): ErrorSentences;
}

const CATALOGUES: Readonly<Record<LanguageCode, Catalogue>> = { de, en, es, fr, zh };

export interface PrintTexts {
  words: PrintWords;
  finding(finding: FileFinding): string;
  error(error: PrintFileError | ReadError): string;
}

const made = new Map<Language, PrintTexts>();

export function textsOf(language: Language): PrintTexts {
  let texts = made.get(language);
  if (texts === undefined) {
    const catalogue = CATALOGUES[language.code];
    const { format } = language;
    const faults = catalogue.faults(format);
    const say = (sentences: object, said: Coded): string => {
      const sentence = (sentences as Readonly<Record<string, (detail: unknown, fault: string) => string>>)[said.code];
      const fault = (said.detail as { fault?: LayerFault } | undefined)?.fault;
      return sentence?.(said.detail ?? null, fault === undefined ? "" : say(faults, fault)) ?? said.code;
    };
    const findings = catalogue.findings(format);
    const errors = catalogue.errors(format);
    texts = {
      words: catalogue.words(format),
      finding: (finding) => say(findings, finding),
      error: (error) => say(errors, error),
    };
    made.set(language, texts);
  }
  return texts;
}

interface Coded {
  code: string;
  detail?: unknown;
}
