/**
 * Languages. English is in code, in the rooms that say it; every other language is a dictionary with the same keys, fetched on demand.
 * English replaces what a dictionary lacks.
 */
import { FORMAT_WORDS, formatOf } from "./format.js";
import { ENGLISH, room, type Bound, type Dictionary, type Spoken } from "./messages.js";
import { model } from "./model.js";
import { offers } from "./offers.js";
import { plan } from "./plan.js";
import { plate } from "./plate.js";
import { settings } from "./settings.js";
import { view } from "./view.js";

export type { Format } from "./format.js";

/** English of the element, except for what is fetched with its panel. */
const ELEMENT = { format: FORMAT_WORDS, ...model, ...settings, ...plan, ...plate, ...view, offers } as const;

const elementTexts = room("", ELEMENT);

export type Texts = Bound<typeof ELEMENT>;

/** A language in use: its texts and number formats. */
export interface Language extends Spoken {
  /** Language of the dictionary. */
  readonly code: LanguageCode;
  /** BCP 47 tag, as requested if there is a dictionary for it: `de-AT` has German words and Austrian numbers. */
  readonly locale: string;
  readonly texts: Texts;
}

/** Each language's own name. */
export const LANGUAGE_NAMES = { en: "English", de: "Deutsch", es: "Español", fr: "Français", zh: "中文" } as const;

export type LanguageCode = keyof typeof LANGUAGE_NAMES;

export const LANGUAGES = Object.keys(LANGUAGE_NAMES) as LanguageCode[];

type Foreign = Exclude<LanguageCode, "en">;
type Fetch = () => Promise<{ default: Dictionary }>;

/**
 * The messages on show at first, and the rest, of rooms that are fetched on demand. A build divides each file into these
 * (`package/dictionaries.ts`); without a build, both are the whole file.
 */
const DICTIONARIES: Readonly<Record<Foreign, Readonly<Record<"first" | "rest", Fetch>>>> = {
  de: { first: () => import("./de.json"), rest: () => import("./de.json") },
  es: { first: () => import("./es.json"), rest: () => import("./es.json") },
  fr: { first: () => import("./fr.json"), rest: () => import("./fr.json") },
  zh: { first: () => import("./zh.json"), rest: () => import("./zh.json") },
};

/** Messages that have arrived, of languages in use. */
const dictionaries = new Map<LanguageCode, Dictionary>([["en", {}]]);
const files = new Map<Fetch, Promise<Dictionary | null>>();
const loading = new Map<Foreign, Promise<boolean>>();
let needsRest = false;
const made = new Map<string, Language>();

/** The first of these locales with a language; English if there is none, or if it has not been fetched. */
export function languageOf(...locales: readonly string[]): Language {
  const wanted = locales.find((locale) => codeOf(locale) !== null) ?? "en";
  const locale = dictionaries.has(codeOf(wanted) ?? "en") ? wanted : "en";
  let language = made.get(locale);
  if (language === undefined) {
    const code = codeOf(locale) ?? "en";
    const dictionary = dictionaries.get(code) ?? {};
    const message = (key: string): string | undefined => dictionary[key] ?? ENGLISH.get(key);
    const word = (name: keyof typeof FORMAT_WORDS): string => message(`format.${name}`) ?? FORMAT_WORDS[name];
    const format = formatOf(locale, { hours: word("hours"), minutes: word("minutes"), separator: word("separator") });
    made.set(locale, (language = { code, locale, format, message, texts: elementTexts({ format, message }) }));
  }
  return language;
}

/**
 * Fetches the language that {@link languageOf} would choose for these locales. Null if it is present, or if an earlier fetch failed and
 * English replaces it; the promise is of false if this one fails.
 */
export function fetchLanguage(...locales: readonly string[]): Promise<boolean> | null {
  const code = codeFor(...locales);
  if (code === "en" || dictionaries.has(code)) return null;
  let arriving = loading.get(code);
  if (arriving === undefined) loading.set(code, (arriving = fill(code)));
  return arriving;
}

/** Fetches the rest of the languages in use, and from then on with each language. Rooms that are fetched on demand wait for it. */
export async function fetchRest(): Promise<void> {
  needsRest = true;
  await Promise.all([...loading.keys()].map(fill));
}

/** Fetches what is needed of a dictionary. English replaces what cannot be fetched. */
async function fill(code: Foreign): Promise<boolean> {
  const { first, rest } = DICTIONARIES[code];
  const parts = await Promise.all([fileOf(first), needsRest ? fileOf(rest) : null]);
  dictionaries.set(code, Object.assign(dictionaries.get(code) ?? {}, ...parts));
  return parts[0] !== null;
}

/** Each file is fetched once; null if that fails. */
function fileOf(fetch: Fetch): Promise<Dictionary | null> {
  let file = files.get(fetch);
  if (file === undefined) files.set(fetch, (file = fetch().then(({ default: messages }) => messages, () => null)));
  return file;
}

/** The first of these locales with a language, fetched or not; English if there is none. */
function codeFor(...locales: readonly string[]): LanguageCode {
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
