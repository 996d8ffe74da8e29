/** The languages of the element: one catalogue each; the compiler holds all of them to the same keys. */
import * as de from "./de/index.js";
import * as en from "./en/index.js";
import * as es from "./es/index.js";
import { formatOf, type Format } from "./format.js";
import * as fr from "./fr/index.js";
import * as zh from "./zh/index.js";

export type { Format } from "./format.js";

/** The texts of any language. */
export type Texts = ReturnType<typeof en.en>;

/** A language in use: its texts, and how it writes numbers. */
export interface Language {
  /** The language of its catalogue. */
  code: LanguageCode;
  /** BCP 47, as requested if there is a catalogue for it: `de-AT` has German words and Austrian numbers. */
  locale: string;
  texts: Texts;
  format: Format;
}

const CATALOGUES = {
  en: { units: en.units, texts: en.en },
  de: { units: de.units, texts: de.de },
  es: { units: es.units, texts: es.es },
  fr: { units: fr.units, texts: fr.fr },
  zh: { units: zh.units, texts: zh.zh },
} as const;

export type LanguageCode = keyof typeof CATALOGUES;

export const LANGUAGES = Object.keys(CATALOGUES) as LanguageCode[];

const made = new Map<string, Language>();

/** The first of these locales with a catalogue; English if there is none. */
export function languageOf(...locales: readonly string[]): Language {
  const locale = locales.find((locale) => codeOf(locale) !== null) ?? "en";
  let language = made.get(locale);
  if (language === undefined) {
    const code = codeOf(locale) ?? "en";
    const { units, texts } = CATALOGUES[code];
    const format = formatOf(locale, units);
    made.set(locale, (language = { code, locale, format, texts: texts(format) }));
  }
  return language;
}

function codeOf(locale: string): LanguageCode | null {
  try {
    const { language } = new Intl.Locale(locale);
    return LANGUAGES.find((code) => code === language) ?? null;
  } catch {
    return null;
  }
}
