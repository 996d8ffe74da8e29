/** Layout parts for several models: the copies field, the button that adds a model, and the list, fetched with the second copy. */
import { html, nothing, type TemplateResult } from "lit";
import type { Facts } from "./facts.js";
import { MODEL_FILES } from "./state/choice.js";
import { FetchedPanel } from "./parts/part.js";
import { USUAL_VOLUME } from "./state/plate.js";
import { copiesField } from "./panels/copies-field.js";

const plateCode = new FetchedPanel("plate", () => import("./panels/plate-panel.js"), ({ definePlate }) => definePlate());

function addButton({ language, added }: Facts): TemplateResult {
  return html`<label class="button small">
    <input class="visually-hidden" type="file" accept=${MODEL_FILES} multiple @change=${added} />${language.texts.plate.add}
  </label>`;
}

/** The copies field of a single model, or the list of all models. */
export function platePanel(facts: Facts): TemplateResult | typeof nothing {
  const { element, session, language, saveAll } = facts;
  const { plate, busy, failure } = session;
  if (plate.entries.length === 0) return nothing;
  if (!plate.isSeveral) {
    const { copies } = language.texts.plate;
    return html`<div class="copies-row">
      <span class="copies-number"><span aria-hidden="true">${copies}</span>${copiesField(plate, 0, language)}</span> ${addButton(facts)}
    </div>`;
  }
  if (!plateCode.isThere) return plateCode.instead(element, language);
  const { texts, format } = language;
  const [x, y] = USUAL_VOLUME.volume_mm.map(format.count);
  return html`<div class="copies-row">
      ${addButton(facts)}
      <button class="small" @click=${() => plate.arrange()}>${texts.plate.arrange}</button>
    </div>
    ${session.settings.printer === "" ? html`<p class="quiet">${texts.plate.usual({ size: `${x} × ${y}` })}</p>` : nothing}
    <cusp-plate
    .plate=${plate}
    .entries=${plate.entries}
    .selected=${plate.selected}
    .arranging=${plate.arranging}
    .number=${plate.number}
    .plates=${plate.plates}
    .planned=${plate.planned}
    .placed=${plate.placed}
    .problems=${plate.problems}
    .misread=${plate.misread}
    .isBusy=${busy !== null || failure !== null}
    .language=${language}
    @cusp-save-all=${saveAll}
  ></cusp-plate>`;
}
