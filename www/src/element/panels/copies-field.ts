/** Field for the number of copies of a model, with step buttons. */
import { html, nothing, type TemplateResult } from "lit";
import { typed } from "../parts/typed.js";
import { MOST_COPIES, type Plate } from "../state/plate.js";
import { faultWords } from "../state/settings.js";
import type { Language } from "../../texts/index.js";
import { shown } from "../../api/visible.js";

export function copiesField(plate: Plate, place: number, language: Language): TemplateResult | typeof nothing {
  const entry = plate.entries[place];
  if (entry === undefined) return nothing;
  const { copies, key, model } = entry;
  const words = language.texts.plate;
  const name = words.copiesOf({ name: shown(model.name) });
  const misread = plate.misread?.key === key ? plate.misread : null;
  const step = (what: string, sign: string, by: number): TemplateResult => html`<button
    class="small step"
    aria-label=${`${what}: ${name}`}
    ?disabled=${copies + by < 1 || copies + by > MOST_COPIES}
    @click=${() => plate.setCopies(place, copies + by)}
  >
    ${sign}
  </button>`;
  return html`<span class="copies">
      ${step(words.fewer, "−", -1)}
      <input
        type="text"
        inputmode="numeric"
        aria-label=${name}
        aria-invalid=${misread === null ? "false" : "true"}
        .value=${typed(misread?.text ?? String(copies))}
        @change=${({ target }: Event) => plate.typeCopies(place, (target as HTMLInputElement).value, language.format.decimal)}
      />
      ${step(words.more, "+", 1)}
    </span>
    ${misread === null ? nothing : html`<p class="copies-fault" role="alert">${faultWords(misread.fault, language)}</p>`}`;
}
