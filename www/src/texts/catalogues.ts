/** Text catalogues: English is built in, and the other languages are fetched on demand. */
import type { LanguageCode } from "./index.js";

export class Catalogues<Words> {
  readonly #loaders: Readonly<Record<Exclude<LanguageCode, "en">, () => Promise<{ words: Words }>>>;
  readonly #english: Words;
  readonly #there = new Map<LanguageCode, Words>();

  constructor(english: Words, loaders: Readonly<Record<Exclude<LanguageCode, "en">, () => Promise<{ words: Words }>>>) {
    this.#english = english;
    this.#loaders = loaders;
  }

  /** If a language cannot be fetched, English replaces it. */
  async fetch(code: LanguageCode): Promise<void> {
    if (code === "en" || this.#there.has(code)) return;
    const { words } = await this.#loaders[code]().catch(() => ({ words: this.#english }));
    this.#there.set(code, words);
  }

  /** Texts of a fetched language. */
  of(code: LanguageCode): Words {
    return this.#there.get(code) ?? this.#english;
  }
}
