/** The tools for painting weights: the brush, the choice of colours, and weight files. */
import { chosen } from "../parts/chosen.js";
import { css, html, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import { paintingTexts } from "../../texts/painting.js";
import type { Brush, BrushMode } from "../../view/paint/brush.js";
import type { Heat } from "../../view/paint/heat.js";
import { WEIGHT_STEPS, type Settings } from "../state/settings.js";

/** Meaning of the model's colours while painting: weights, or the resulting layers. */
export type Colours = Heat | "layers";

export interface PaintTools {
  readonly brush: Brush;
  readonly colours: Colours;
  readonly settings: Pick<Settings, "saliency" | "weightMin">;
  /** True if saliency is being computed. */
  readonly isFinding: boolean;
  readonly canUndo: boolean;
  readonly canRedo: boolean;
  readonly isPainted: boolean;
  /** Maximum size of the brush, mm. */
  readonly most_mm: number;
  readonly language: Language;
  brushed(change: Partial<Brush>): void;
  coloured(colours: Colours): void;
  changed(change: Partial<Settings>): void;
  undo(): void;
  redo(): void;
  clear(): void;
  open(file: File): void;
  save(): void;
}

const MODES: readonly BrushMode[] = ["less", "more", "erase", "soften"];
const COLOURS: readonly Colours[] = ["paint", "saliency", "product", "layers"];
const CREASES = [10, 20, 30, 45, 60] as const;

/** Steps of the brush's size, finer at the small end. */
const SIZE_STEPS = 100;

/** Minimum size of the brush, as a fraction of the maximum. */
const FINEST = 0.01;

const sizeAt = (step: number, most_mm: number): number => most_mm * FINEST ** (1 - step / SIZE_STEPS);
const stepOf = (size_mm: number, most_mm: number): number =>
  Math.round(SIZE_STEPS * (1 - Math.log(size_mm / most_mm) / Math.log(FINEST)));

const numberOf = ({ target }: Event): number => Number((target as HTMLInputElement).value);
const isOn = ({ target }: Event): boolean => (target as HTMLInputElement).checked;

export function paintTools(tools: PaintTools): TemplateResult {
  const { brush, colours, settings, most_mm, language, brushed, changed } = tools;
  const { format } = language;
  const words = paintingTexts(language);
  const slider = (
    name: string,
    [least, most, step]: readonly [number, number, number],
    value: number,
    said: string,
    set: (value: number) => void,
  ): TemplateResult => html`<label class="slider">
    <span>${name}</span><span class="said" aria-hidden="true">${said}</span>
    <input
      type="range"
      min=${least}
      max=${most}
      step=${step}
      .value=${String(value)}
      aria-valuetext=${said}
      @input=${(event: Event) => set(numberOf(event))}
    />
  </label>`;
  const box = (name: string, checked: boolean, set: (on: boolean) => void): TemplateResult => html`<label class="box">
    <input type="checkbox" .checked=${checked} @change=${(event: Event) => set(isOn(event))} />${name}
  </label>`;
  const button = (name: string, isPossible: boolean, act: () => void): TemplateResult =>
    html`<button class="small" ?disabled=${!isPossible} @click=${act}>${name}</button>`;
  return html`<section class="paint" aria-label=${words.title}>
    <p class="quiet">${words.hint}</p>
    <fieldset class="modes">
      <legend>${words.brush}</legend>
      ${MODES.map(
        (mode) => html`<label class="box">
          <input
            type="radio"
            name="mode"
            .checked=${brush.mode === mode}
            @change=${() => brushed({ mode })}
          />${words.modes[mode]}
        </label>`,
      )}
    </fieldset>
    <div class="columns">
      <div>
        ${slider(words.size, [0, SIZE_STEPS, 1], stepOf(brush.size_mm, most_mm), format.size(brush.size_mm), (step) =>
          brushed({ size_mm: sizeAt(step, most_mm) }),
        )}
        ${slider(words.strength, [0.05, 1, 0.05], brush.strength, format.percent(brush.strength), (strength) =>
          brushed({ strength }),
        )}
        ${box(words.fills, brush.fills, (fills) => brushed({ fills }))}
        <label class="choice" ?hidden=${!brush.fills}>
          ${words.crease}
          <select @change=${(event: Event) => brushed({ crease_deg: numberOf(event) })}>
            ${CREASES.map((deg) => html`<option value=${deg} ?selected=${deg === brush.crease_deg}>${deg}°</option>`)}
          </select>
        </label>
        ${box(words.mirrors, brush.mirrors, (mirrors) => brushed({ mirrors }))}
      </div>
      <div>
        ${slider(words.base, [0, 1, 0.05], brush.base, format.percent(brush.base), (base) => brushed({ base }))}
        ${slider(words.least, [0, WEIGHT_STEPS.length - 1, 1], WEIGHT_STEPS.indexOf(settings.weightMin), format.percent(Number(settings.weightMin)), (step) =>
          changed({ weightMin: WEIGHT_STEPS[step] ?? settings.weightMin }),
        )}
        ${box(words.saliency, settings.saliency === "on", (on) => changed({ saliency: on ? "on" : "off" }))}
        <label class="choice">
          ${words.show}
          <select @change=${({ target }: Event) => tools.coloured((target as HTMLSelectElement).value as Colours)}>
            ${COLOURS.map((it) => html`<option value=${it} ?selected=${it === colours}>${words.colours[it]}</option>`)}
          </select>
        </label>
        <p class="quiet" role="status">${tools.isFinding ? words.finding : ""}</p>
      </div>
    </div>
    <div class="actions">
      ${button(words.undo, tools.canUndo, tools.undo)} ${button(words.redo, tools.canRedo, tools.redo)}
      ${button(words.clear, tools.isPainted, tools.clear)} ${button(words.save, tools.isPainted, tools.save)}
      <label class="button small">
        ${words.open}
        <input
          class="visually-hidden"
          type="file"
          accept=".weights"
          @change=${(event: Event) => {
            const [file] = chosen(event);
            if (file !== undefined) tools.open(file);
          }}
        />
      </label>
    </div>
  </section>`;
}

export const paintStyles = css`
  .paint {
    display: grid;
    align-content: start;
    gap: 0.75rem;
    min-width: 0;
    overflow: auto;
    scrollbar-width: thin;
    /* Room for focus rings and for the scroll bar. */
    padding: 0.25rem 0.75rem 0.25rem 0.25rem;
    font-size: 0.875rem;
  }
  .paint legend {
    padding: 0;
    color: var(--cusp-quiet);
  }
  .paint .modes {
    display: flex;
    flex-wrap: wrap;
    gap: 0 1.25rem;
  }
  .paint .columns {
    display: grid;
    grid-template-columns: repeat(auto-fit, minmax(min(14rem, 100%), 1fr));
    gap: 0 2rem;
  }
  .paint .slider {
    display: grid;
    grid-template-columns: 1fr auto;
    gap: 0 1rem;
    padding-block: 0.25rem;
  }
  .paint .slider input {
    grid-column: 1 / -1;
    width: 100%;
    min-height: 1.75rem;
    margin: 0;
  }
  .paint .said {
    color: var(--cusp-quiet);
    font-variant-numeric: tabular-nums;
  }
  .paint .box,
  .paint .choice {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    min-height: 2.25rem;
  }
  .paint .choice[hidden] {
    display: none;
  }
  .paint .choice {
    flex-wrap: wrap;
    justify-content: space-between;
  }
  .paint input {
    accent-color: var(--cusp-accent);
  }
  .paint .box input {
    width: 1.125rem;
    height: 1.125rem;
    margin: 0;
  }
  .paint select {
    font: inherit;
    min-height: 2.25rem;
    padding: 0.25rem 0.5rem;
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    background: var(--cusp-card);
    color: var(--cusp-text);
  }
  .paint .actions {
    display: flex;
    flex-wrap: wrap;
    gap: 0.375rem;
  }
  .paint .button:focus-within {
    outline: 3px solid var(--cusp-focus);
    outline-offset: 2px;
  }
`;
