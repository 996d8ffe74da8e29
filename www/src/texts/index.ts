/**
 * Languages of the element: one catalogue each, with the same keys as enforced by the compiler. English is built in; the others are fetched
 * on demand.
 */
import * as en from "./en/index.js";
import { formatOf, type Format } from "./format.js";

export type { Format } from "./format.js";

export type Texts = ReturnType<typeof en.en>;

/** A language in use: its texts and number formats. */
export interface Language {
  /** Language of the catalogue. */
  code: LanguageCode;
  /** BCP 47 tag, as requested if there is a catalogue for it: `de-AT` has German words and Austrian numbers. */
  locale: string;
  texts: Texts;
  format: Format;
}

interface Catalogue {
  units: typeof en.units;
  texts(format: Format): Texts;
}

const LOADERS = {
  en: async (): Promise<Catalogue> => ENGLISH,
  de: async (): Promise<Catalogue> => import("./de/index.js").then(({ units, de: texts }) => ({ units, texts })),
  es: async (): Promise<Catalogue> => import("./es/index.js").then(({ units, es: texts }) => ({ units, texts })),
  fr: async (): Promise<Catalogue> => import("./fr/index.js").then(({ units, fr: texts }) => ({ units, texts })),
  zh: async (): Promise<Catalogue> => import("./zh/index.js").then(({ units, zh: texts }) => ({ units, texts })),
} as const;

export type LanguageCode = keyof typeof LOADERS;

export const LANGUAGES = Object.keys(LOADERS) as LanguageCode[];

/** Each language's own name. */
export const LANGUAGE_NAMES: Readonly<Record<LanguageCode, string>> = {
  en: "English",
  de: "Deutsch",
  es: "Español",
  fr: "Français",
  zh: "中文",
};

const ENGLISH: Catalogue = { units: en.units, texts: en.en };

const catalogues = new Map<LanguageCode, Catalogue>([["en", ENGLISH]]);
const loading = new Map<LanguageCode, Promise<void>>();
const made = new Map<string, Language>();

/** The first of these locales with a language; English if there is none, or if it has not been fetched. */
export function languageOf(...locales: readonly string[]): Language {
  const wanted = locales.find((locale) => codeOf(locale) !== null) ?? "en";
  const locale = catalogues.has(codeOf(wanted) ?? "en") ? wanted : "en";
  let language = made.get(locale);
  if (language === undefined) {
    const code = codeOf(locale) ?? "en";
    const { units, texts } = catalogues.get(code) ?? ENGLISH;
    const format = formatOf(locale, units);
    made.set(locale, (language = { code, locale, format, texts: texts(format) }));
  }
  return language;
}

/**
 * Fetches the language that {@link languageOf} would choose for these locales. Null if it is present, or if an earlier fetch failed and
 * English replaces it.
 */
export function fetchLanguage(...locales: readonly string[]): Promise<void> | null {
  const code = codeFor(...locales);
  if (catalogues.has(code)) return null;
  let arriving = loading.get(code);
  if (arriving === undefined) {
    arriving = LOADERS[code]().then(
      (catalogue) => void catalogues.set(code, catalogue),
      () => void catalogues.set(code, ENGLISH),
    );
    loading.set(code, arriving);
  }
  return arriving;
}

/** The first of these locales with a language, fetched or not; English if there is none. */
export function codeFor(...locales: readonly string[]): LanguageCode {
  return locales.map(codeOf).find((code) => code !== null) ?? "en";
}

function codeOf(locale: string): LanguageCode | null {
  try {
    const { language } = new Intl.Locale(locale);
    return LANGUAGES.find((code) => code === language) ?? null;
  } catch {
    return null;
  }
}
