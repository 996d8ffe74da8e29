/** Warnings about the models and the plan, with offers. */
import { html, nothing, type TemplateResult } from "lit";
import type { PlateChoice } from "../../api/wire.js";
import { shown } from "../../api/visible.js";
import type { Language } from "../../texts/index.js";
import { offerButtons } from "../parts/problem-box.js";
import { towersOffer } from "../parts/towers-offer.js";
import { adviseOn, type Warned } from "../state/advice.js";
import type { Session } from "../state/session.js";

/** With several models, each warning names its model. */
export function warnings(all: readonly Warned[], session: Session, language: Language, saveTowers: () => void): readonly TemplateResult[] {
  const { model, fixed } = session;
  const isOfSelected = (names: ReadonlySet<string>): boolean => names.size === 0 || names.has(shown(model?.name ?? ""));
  return adviseOn(all, language, fixed).map(
    ({ text, offers, towers, plates, parts, names }) => html`<div class="warning">
      <p>${names.size > 0 ? html`<b>${language.format.all([...names])}</b>: ` : nothing}${text}</p>
      ${isOfSelected(names) && plates !== null ? plateList(session, plates, text, language) : nothing}
      ${isOfSelected(names) && parts ? partsOffer(session, language) : nothing}
      ${offerButtons(offers, (change) => session.change(change))}
      ${towers ? towersOffer(session.towers, language, saveTowers) : nothing}
    </div>`,
  );
}

/** Button that reads what is taken for supports as parts of the model; undo takes it back. */
function partsOffer(session: Session, { texts }: Language): TemplateResult {
  const read = (): void => void session.reread({ ...session.model?.reading, supports_as_model: true });
  return html`<div class="offers"><button class="small" @click=${read}>${texts.offers.parts}</button></div>`;
}

/** List of the plates of a project, to read another one. */
function plateList(session: Session, { plate_number, plates }: PlateChoice, label: string, { texts, format }: Language): TemplateResult {
  const numbers = Array.from({ length: plates }, (_, index) => index + 1);
  const chosen = ({ target }: Event): void => {
    const list = target as HTMLSelectElement;
    const number = Number(list.value);
    // This plate stays open until the other is read.
    list.value = String(plate_number);
    void session.reread({ ...session.model?.reading, plate_number: number });
  };
  return html`<select aria-label=${label} @change=${chosen}>
    ${numbers.map(
      (number) => html`<option value=${number} .selected=${number === plate_number}>${texts.plate.plate({ number: format.count(number), count: format.count(plates) })}</option>`,
    )}
  </select>`;
}
