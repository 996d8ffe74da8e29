/** Texts of which English is always there, and each other language is fetched when somebody wants it. */
import type { LanguageCode } from "./index.js";

export class Catalogues<Words> {
  readonly #loaders: Readonly<Record<Exclude<LanguageCode, "en">, () => Promise<{ words: Words }>>>;
  readonly #english: Words;
  readonly #there = new Map<LanguageCode, Words>();

  constructor(english: Words, loaders: Readonly<Record<Exclude<LanguageCode, "en">, () => Promise<{ words: Words }>>>) {
    this.#english = english;
    this.#loaders = loaders;
  }

  /** English stands in for a language that cannot be fetched. */
  async fetch(code: LanguageCode): Promise<void> {
    if (code === "en" || this.#there.has(code)) return;
    const { words } = await this.#loaders[code]().catch(() => ({ words: this.#english }));
    this.#there.set(code, words);
  }

  /** The texts of a language that was fetched. */
  of(code: LanguageCode): Words {
    return this.#there.get(code) ?? this.#english;
  }
}
