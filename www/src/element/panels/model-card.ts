import { css, html, nothing, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import { offerButtons } from "../parts/problem-box.js";
import { MODEL_FILES } from "../state/choice.js";
import { allowed, bestUniform } from "../state/offers.js";
import { enough } from "../state/comparison.js";
import type { Session } from "../state/session.js";

export const modelStyles = css`
  dt {
    color: var(--cusp-quiet);
    font-size: 0.8125rem;
  }
  .files button {
    min-width: 2.25rem;
    padding: 0;
    font-size: 1.25rem;
  }
  .flip:dir(rtl) {
    scale: -1 1;
  }
  .open-other label {
    position: relative;
  }
`;

export interface ModelActions {
  picked(event: Event): void;
  openFile(place: number): void;
}

/** Button for uniform layers, shown if they do about as well as the plan. */
export function uniformOffer(session: Session, language: Language): TemplateResult | typeof nothing {
  const best = session.result === null ? null : enough(session.result);
  if (best === null) return nothing;
  return html`${offerButtons(allowed([bestUniform(best, language)], session.fixed), (change) => session.change(change))}`;
}

/**
 * @param more shown below the facts of the model
 * @param below shown below the button that opens another model
 */
export function modelCard(
  session: Session,
  language: Language,
  { picked, openFile }: ModelActions,
  more: unknown = nothing,
  below: unknown = nothing,
): TemplateResult {
  const { model, result, files, place } = session;
  const { texts, format } = language;
  if (model === null) return html``;
  const { name, info } = model;
  const own = info.size_mm;
  // The extent in the current pose, without supports.
  const size = result?.own?.size_mm ?? own;
  const isOfFile = size.every((mm, axis) => Math.abs(mm - (own[axis] ?? 0)) <= 1e-3 * mm);
  return html`<section class="card model" part="model" aria-label=${texts.model.region}>
    <h2 class="model-name" tabindex="-1">${name}</h2>
    <dl class="figures">
      <div>
        <dt>${texts.model.size}</dt>
        <dd title=${texts.model.sizeHelp}>${format.dimensions(size)}</dd>
        ${isOfFile ? nothing : html`<dd class="quiet">${texts.model.inFile({ size: format.dimensions(own) })}</dd>`}
      </div>
      <div>
        <dt>${texts.model.facets}</dt>
        <dd>${format.count(info.facets)}</dd>
      </div>
      <div>
        <dt>${texts.model.surface}</dt>
        <dd>${info.closed ? texts.model.closed : texts.model.open}</dd>
      </div>
    </dl>
    ${more}
    ${files.length < 2
      ? nothing
      : html`<div class="files">
          <button class="small" aria-label=${texts.open.previous} ?disabled=${place === 0} @click=${() => openFile(place - 1)}>
            <span class="flip">‹</span>
          </button>
          <span class="quiet">${texts.open.place({ place: format.count(place + 1), total: format.count(files.length) })}</span>
          <button
            class="small"
            aria-label=${texts.open.next}
            ?disabled=${place === files.length - 1}
            @click=${() => openFile(place + 1)}
          >
            <span class="flip">›</span>
          </button>
        </div>`}
    <div class="open-other">
      <label class="button small">
        <input class="visually-hidden" type="file" accept=${MODEL_FILES} multiple @change=${picked} />${texts.open.another}
      </label>
      <slot name="actions"></slot>
    </div>
    ${below}
  </section>`;
}
