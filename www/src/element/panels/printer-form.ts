/** `<cusp-printer-form>`: the description of a printer that is not in the list, typed or taken from a file. */
import { css, html, type TemplateResult } from "lit";
import { FORMATS, isFilament } from "../../api/facts.js";
import type { Format, KnownPrinter, Printer } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import { ownPrinterTexts } from "../../texts/own-printer.js";
import { elementWith, given, own } from "../../view/properties.js";
import { define } from "../define.js";
import { typed } from "../parts/typed.js";
import { isPrinter } from "../state/printer.js";
import { read } from "../state/typed.js";
import { shared } from "../styles/shared.js";
import { textField } from "../styles/text-field.js";

/** Numbers of a description, by the fields of the form. */
interface Numbers {
  readonly width: number;
  readonly depth: number;
  readonly pitch_um: number;
  readonly pitch_y_um: number;
  readonly height_mm: number;
}

const LAYERS = ["untried", "yes", "no"] as const satisfies readonly KnownPrinter["variable_layers"][];

const PROPERTIES = {
  /** The description to edit; null for a new one. */
  printer: given<Printer | null>(null),
  language: given<Language>(languageOf()),
  /** Numbers of a new description, until all are there. */
  draft: own<Partial<Numbers>>({}),
  /** Its other fields. */
  rest: own<Partial<Printer>>({ model: "" }),
};

/** Description with other numbers; null while one is missing. Pixels and their sides make the plate. */
export function described(printer: Partial<Printer>, numbers: Partial<Numbers>): Printer | null {
  const { width = 0, depth = 0, pitch_um = 0, pitch_y_um = pitch_um, height_mm = 0 } = numbers;
  const side = (pixels: number, pitch_um: number): number => Math.round(pixels * pitch_um) / 1000;
  const whole = {
    ...printer,
    pixels: [Math.round(width), Math.round(depth)],
    pitch_um: [pitch_um, pitch_y_um],
    volume_mm: [side(width, pitch_um), side(depth, pitch_y_um), height_mm],
  };
  return isPrinter(whole) ? whole : null;
}

function numbersOf({ pixels: [width, depth], pitch_um: [pitch_um, pitch_y_um], volume_mm: [, , height_mm] }: Printer): Numbers {
  return { width, depth, pitch_um, pitch_y_um, height_mm };
}

export class CuspPrinterForm extends elementWith(PROPERTIES) {
  static override styles = [
    shared,
    css`
      :host {
        display: grid;
        gap: 0.5rem;
        margin-top: 0.5rem;
        font-size: 0.875rem;
      }
      .pair {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
        gap: 0.5rem 0.75rem;
        align-items: end;
      }
      label:not(.button) {
        display: grid;
        gap: 0.25rem;
        font-weight: 550;
      }
      .check:not(.button) {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        min-height: 2.25rem;
        font-weight: 400;
      }
      .check input {
        width: 1.125rem;
        height: 1.125rem;
        margin: 0;
        accent-color: var(--cusp-accent);
      }
      input[type="text"],
      select {
        ${textField}
        font-weight: 400;
        width: 100%;
        min-width: 0;
      }
      .button {
        justify-self: start;
      }
    `,
  ];

  override render(): TemplateResult {
    const { printer, language } = this;
    const words = ownPrinterTexts(language);
    const { settings } = language.texts;
    const { model = "", format = "png", is_mirrored = true, variable_layers = "untried" } = printer ?? this.rest;
    const select = <T extends string>(name: string, value: T, choices: readonly (readonly [T, string])[], set: (value: T) => void): TemplateResult => html`<label>
      ${name}
      <select @change=${({ target }: Event) => set((target as HTMLSelectElement).value as T)}>
        ${choices.map(([it, text]) => html`<option value=${it} ?selected=${it === value}>${text}</option>`)}
      </select>
    </label>`;
    const formats = FORMATS.filter((it) => !isFilament(it)).map((it): readonly [Format, string] => [it, settings.formats[it]]);
    return html`
      <label>
        ${words.name}
        <input type="text" autocomplete="off" .value=${typed(model)} @change=${(event: Event) => this.#change({ model: text(event) })} />
      </label>
      <div class="pair">
        ${this.#number("width", words.width)} ${this.#number("depth", words.depth)} ${this.#number("pitch_um", words.pitch)}
        ${this.#number("pitch_y_um", words.pitchY)} ${this.#number("height_mm", words.height)}
      </div>
      ${select(settings.format, format, formats, (format) => this.#change({ format }))}
      <label class="check">
        <input type="checkbox" .checked=${is_mirrored} @change=${({ target }: Event) => this.#change({ is_mirrored: (target as HTMLInputElement).checked })} />
        ${words.mirrored}
      </label>
      ${select(words.layers, variable_layers, LAYERS.map((it) => [it, settings.layersOf[it]] as const), (variable_layers) => this.#change({ variable_layers }))}
      <label class="button small">
        <input class="visually-hidden" type="file" accept=".json,application/json" @change=${this.#open} />${settings.openPrinter}
      </label>
    `;
  }

  get #numbers(): Partial<Numbers> {
    return this.printer === null ? this.draft : numbersOf(this.printer);
  }

  #number(name: keyof Numbers, label: string): TemplateResult {
    const value = this.#numbers[name];
    const shown = value === undefined ? "" : this.language.format.exact(value);
    const change = (event: Event): void => {
      const { value: entered } = read(text(event), name === "height_mm" ? "mm" : "", this.language.format.decimal);
      if (entered === null || entered <= 0) (event.target as HTMLInputElement).value = shown;
      else this.#fill({ [name]: entered });
    };
    return html`<label>${label}<input type="text" inputmode="decimal" autocomplete="off" .value=${typed(shown)} @change=${change} /></label>`;
  }

  #fill(change: Partial<Numbers>): void {
    this.draft = { ...this.#numbers, ...change };
    const printer = described(this.printer ?? this.rest, this.draft);
    if (printer !== null) this.#say(printer);
  }

  #change(change: Partial<Printer>): void {
    if (this.printer === null) this.rest = { ...this.rest, ...change };
    else this.#say({ ...this.printer, ...change });
  }

  #say(printer: Printer): void {
    this.dispatchEvent(new CustomEvent<Printer>("cusp-printer", { detail: printer }));
  }

  readonly #open = ({ target }: Event): void => {
    const [file] = (target as HTMLInputElement).files ?? [];
    if (file !== undefined) this.dispatchEvent(new CustomEvent<File>("cusp-open-printer", { detail: file }));
  };
}

const text = ({ target }: Event): string => (target as HTMLInputElement).value.trim();

export function definePrinterForm(): void {
  define("cusp-printer-form", CuspPrinterForm);
}
