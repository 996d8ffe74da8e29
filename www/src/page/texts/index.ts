/** The texts of the page around the element, one catalogue per language. */
import type { Language, LanguageCode } from "../../texts/index.js";
import { Catalogues } from "../../texts/catalogues.js";
import { words as en } from "./en.js";

export interface PageWords {
  title: string;
  tagline: string;
  private: string;
  drop: string;
  /** Label of the language list. */
  languages: string;
  noModel: string;
  tryExample: string;
  printFile: string;
  example: string;
  /** Buttons of the header: models that this browser keeps, named settings, the list of keys. */
  recent: string;
  saved: string;
  keys: string;
  /** Messages about errors of the page itself, with advice. */
  notices: {
    /** Shown if a part could not be loaded. */
    part: string;
    /** Shown if the reader of print files could not be loaded for this file. */
    reader: (name: string) => string;
    /** Shown if this browser did not keep the model. */
    notKept: (name: string) => string;
    reload: string;
    close: string;
  };
  /** The page's promises: a heading and a sentence each. */
  points: readonly (readonly [heading: string, sentence: string])[];
}

const catalogues = new Catalogues<PageWords>(en, {
  de: () => import("./de.js"),
  es: () => import("./es.js"),
  fr: () => import("./fr.js"),
  zh: () => import("./zh.js"),
});

export function fetchPageWords(code: LanguageCode): Promise<void> {
  return catalogues.fetch(code);
}

export function pageWords({ code }: Language): PageWords {
  return catalogues.of(code);
}
