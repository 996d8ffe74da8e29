/** `<cusp-plate>`: the models on the plate, their copies, the rules of arranging, and the plates. */
import { css, html, nothing, type TemplateResult } from "lit";
import type { Plan } from "../../api/index.js";
import type { ArrangeError, Arranging, Placement } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import { errorOf } from "../../texts/problems.js";
import { elementWith, given } from "../../view/properties.js";
import { define } from "../define.js";
import type { Entry, MisreadCopies, Plate } from "../state/plate.js";
import { quaternion } from "../state/settings.js";
import { copiesStyles } from "../styles/copies-styles.js";
import { shared } from "../styles/shared.js";
import { copiesField } from "./copies-field.js";
import { fetchPictures } from "../parts/pictures.js";
import { shown } from "../../api/visible.js";

/** Side of a thumbnail, CSS pixels. */
const THUMBNAIL_PX = 40;

/** Choices for the turning step when arranging, degrees. */
const TURNS_DEG = [0, 15, 45, 90, 180] as const;

/** Maximum spacing in the core, mm. */
const MOST_SPACING_MM = 100;

/** Maximum number of problems listed as sentences; the view marks all. */
const MOST_SENTENCES = 3;

const UPRIGHT = [0, 0, 0, 1] as const;

const PROPERTIES = {
  plate: given<Plate | null>(null),
  entries: given<readonly Entry[]>([]),
  selected: given(0),
  arranging: given<Required<Arranging>>({ spacing_mm: 0, turn_deg: 0 }),
  number: given(0),
  plates: given(1),
  planned: given<Plan | null>(null),
  /** Copies placed by hand. */
  placed: given<readonly Placement[]>([]),
  problems: given<readonly ArrangeError[]>([]),
  misread: given<MisreadCopies | null>(null),
  isBusy: given(false),
  language: given<Language>(languageOf()),
};

export class CuspPlate extends elementWith(PROPERTIES) {
  static override styles = [
    shared,
    copiesStyles,
    css`
      :host {
        display: block;
        margin-top: 0.75rem;
        font-size: 0.875rem;
      }
      ul {
        margin: 0 0 0.5rem;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto;
        align-items: center;
        gap: 0.25rem 0.5rem;
        padding-block: 0.375rem;
        border-top: 1px solid var(--cusp-line);
      }
      li.selected {
        box-shadow: inset 3px 0 var(--cusp-accent);
      }
      canvas {
        width: ${THUMBNAIL_PX}px;
        height: ${THUMBNAIL_PX}px;
        margin-inline-start: 0.375rem;
      }
      .name {
        justify-content: start;
        min-height: 2.25rem;
        padding: 0.25rem;
        border: 0;
        overflow-wrap: anywhere;
        text-align: start;
      }
      .amount {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        grid-column: 1 / -1;
        flex-wrap: wrap;
        justify-content: space-between;
        padding-inline: 0.375rem 0.125rem;
      }
      .amount .quiet {
        font-size: 0.8125rem;
      }
      h3 {
        margin-bottom: 0.5rem;
      }
      .row {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: 0.375rem 0.5rem;
        margin-block: 0.5rem;
      }
      .row label {
        display: flex;
        align-items: center;
        gap: 0.375rem;
      }
      .spacing {
        width: 3.25rem;
      }
      .problem {
        margin-bottom: 0.5rem;
        color: var(--cusp-bad);
      }
      .remove,
      .to {
        min-width: 2.25rem;
        padding: 0;
        font-size: 1.125rem;
      }
      .to span:dir(rtl) {
        scale: -1 1;
      }
    `,
  ];

  /** The model and pose drawn on each canvas. */
  readonly #drawn = new WeakMap<HTMLCanvasElement, string>();
  #drawing: AbortController | null = null;

  override render(): TemplateResult | typeof nothing {
    const { plate, language, problems, placed } = this;
    if (plate === null) return nothing;
    const words = language.texts.plate;
    const sentences = problems.slice(0, MOST_SENTENCES).map((problem) => sentenceOf(problem, language));
    const more = problems.length - sentences.length;
    return html`
      <h3>${words.title}</h3>
      <div aria-live="polite">
        ${sentences.map((sentence) => html`<p class="problem">${sentence}</p>`)}
        ${more > 0 ? html`<p class="problem">${words.others({ count: language.format.count(more) })}</p>` : nothing}
        ${placed.length > 0 && problems.length === 0 ? html`<p class="quiet">${words.moved}</p>` : nothing}
      </div>
      ${this.plates > 1 ? this.#steps(plate) : nothing}
      <ul>
        ${this.entries.map((entry, place) => this.#item(plate, entry, place))}
      </ul>
      ${this.#arranging(plate)}
    `;
  }

  override updated(): void {
    void this.#draw();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#drawing?.abort();
  }

  #item(plate: Plate, entry: Entry, place: number): TemplateResult {
    const { language, entries, planned } = this;
    const { format } = language;
    const words = language.texts.plate;
    const isSelected = place === this.selected;
    const share = planned?.plates.flatMap(({ report }) => report.models).find(({ model }) => model === place);
    return html`<li class=${isSelected ? "selected" : ""}>
      <canvas width=${2 * THUMBNAIL_PX} height=${2 * THUMBNAIL_PX} data-place=${place} aria-hidden="true"></canvas>
      <button class="name" aria-pressed=${isSelected ? "true" : "false"} @click=${() => plate.select(place)}>${shown(entry.model.name)}</button>
      ${entries.length > 1
        ? html`<button class="small remove" aria-label=${words.remove({ name: shown(entry.model.name) })} @click=${() => plate.remove(place)}>×</button>`
        : nothing}
      <div class="amount">
        ${copiesField(plate, place, language)}
        ${share === undefined
          ? nothing
          : html`<span class="quiet figures">${words.each({ time: format.time(share.print_time_s), resin: format.millilitres(share.resin_ml) })}</span>`}
      </div>
    </li>`;
  }

  #arranging(plate: Plate): TemplateResult {
    const { arranging, language } = this;
    const words = language.texts.plate;
    const spaced = ({ target }: Event): void => {
      const input = target as HTMLInputElement;
      const spacing_mm = Number(input.value.trim().replace(",", "."));
      if (input.value.trim() !== "" && spacing_mm >= 0 && spacing_mm <= MOST_SPACING_MM) plate.arrange({ spacing_mm });
      else input.value = String(arranging.spacing_mm);
    };
    const turned = ({ target }: Event): void => plate.arrange({ turn_deg: Number((target as HTMLSelectElement).value) });
    return html`<div class="row">
      <label>
        ${words.spacing}
        <input class="spacing" type="text" inputmode="decimal" .value=${String(arranging.spacing_mm)} @change=${spaced} />
      </label>
      <label>
        ${words.turns}
        <select @change=${turned}>
          ${TURNS_DEG.map(
            (degrees) => html`<option value=${degrees} ?selected=${degrees === arranging.turn_deg}>
              ${degrees === 0 ? words.turnless : words.step({ degrees: String(degrees) })}
            </option>`,
          )}
        </select>
      </label>
    </div>`;
  }

  /** Buttons for each plate and for all plates. */
  #steps(plate: Plate): TemplateResult {
    const { number, plates, planned, language, isBusy } = this;
    const { format } = language;
    const words = language.texts.plate;
    const step = (name: string, sign: string, to: number): TemplateResult => html`<button
      class="small to"
      aria-label=${name}
      ?disabled=${to < 0 || to >= plates || isBusy}
      @click=${() => plate.show(to)}
    >
      <span>${sign}</span>
    </button>`;
    return html`<div class="row plates">
        ${step(words.previous, "‹", number - 1)}
        <span class="figures" aria-live="polite">${words.plate({ number: format.count(number + 1), count: format.count(plates) })}</span>
        ${step(words.next, "›", number + 1)}
        <button class="small all" ?disabled=${isBusy} @click=${() => this.dispatchEvent(new CustomEvent("cusp-save-all"))}>${words.all}</button>
      </div>
      ${planned === null
        ? nothing
        : html`<p class="quiet figures">${words.whole({ time: format.time(planned.print_time_s), resin: format.millilitres(planned.resin_ml) })}</p>`}`;
  }

  /** Draws thumbnails whose model or pose has changed. */
  async #draw(): Promise<void> {
    const { plate, entries } = this;
    if (plate === null) return;
    const stale = [...this.renderRoot.querySelectorAll("canvas")].flatMap((canvas) => {
      const entry = entries[Number(canvas.dataset["place"])];
      if (entry === undefined) return [];
      const key = `${entry.key} ${entry.pose.rotation}`;
      return this.#drawn.get(canvas) === key ? [] : [{ canvas, entry, key }];
    });
    if (stale.length === 0) return;
    this.#drawing?.abort();
    const { signal } = (this.#drawing = new AbortController());
    try {
      const { drawThumbnails } = await fetchPictures();
      for (const { canvas, entry, key } of stale) {
        const positions = await plate.positionsOf(entry);
        if (signal.aborted) return;
        if (positions.length === 0) continue;
        await drawThumbnails(positions, [[canvas, quaternion(entry.pose.rotation) ?? UPRIGHT]], this, signal);
        this.#drawn.set(canvas, key);
      }
    } catch {
      // The list works without pictures.
    }
  }
}

function sentenceOf(problem: ArrangeError, language: Language): string {
  if (problem.code === "plate-outside" || problem.code === "plate-collision") return errorOf(problem.code, problem.detail, "cusp", language);
  return "";
}

export function definePlate(): void {
  define("cusp-plate", CuspPlate);
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-plate": CuspPlate;
  }
}
