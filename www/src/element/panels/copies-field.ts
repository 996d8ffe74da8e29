/** The number of copies of a model: typed, or stepped. */
import { html, type TemplateResult } from "lit";
import { typed } from "../parts/typed.js";
import { MOST_COPIES, type Entry } from "../state/plate.js";
import type { Language } from "../../texts/index.js";
import { shown } from "../../api/visible.js";

export function copiesField({ copies, model }: Entry, language: Language, changed: (copies: number) => void): TemplateResult {
  const words = language.texts.plate;
  const entered = ({ target }: Event): void => {
    const input = target as HTMLInputElement;
    const count = Math.round(Number(input.value.trim()));
    if (count >= 1 && count <= MOST_COPIES) changed(count);
    // What is no number of copies goes back to the number there is.
    else input.value = String(copies);
  };
  const step = (name: string, sign: string, by: number): TemplateResult => html`<button
    class="small step"
    aria-label=${`${name}: ${words.copiesOf(shown(model.name))}`}
    ?disabled=${copies + by < 1 || copies + by > MOST_COPIES}
    @click=${() => changed(copies + by)}
  >
    ${sign}
  </button>`;
  return html`<span class="copies">
    ${step(words.fewer, "−", -1)}
    <input
      type="text"
      inputmode="numeric"
      aria-label=${words.copiesOf(shown(model.name))}
      .value=${typed(String(copies))}
      @change=${entered}
    />
    ${step(words.more, "+", 1)}
  </span>`;
}
