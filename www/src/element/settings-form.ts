/** The settings as a form. It holds nothing: it shows what it is given and says what was typed. */
import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import * as format from "../texts/format.js";
import { METRIC_NAMES, METRICS } from "./metric.js";
import { DEFAULT_SETTINGS, RAYS, usualTolerance, withTolerance, type Faults, type Field, type Settings } from "./settings.js";
import { shared } from "./styles.js";
import { DEFAULTS, type MeshInfo } from "../api/wire.js";

export class CuspSettings extends LitElement {
  static override properties = {
    settings: { attribute: false },
    faults: { attribute: false },
    info: { attribute: false },
    taken: { attribute: false },
  };

  declare settings: Settings;
  declare faults: Faults;
  declare info: MeshInfo | null;
  /** The tolerance that the core took where none is typed; null if it is not known. */
  declare taken: number | null;
  /** Whether more settings are open at first; null before there are any settings. */
  #moreAtFirst: boolean | null = null;

  constructor() {
    super();
    this.faults = {};
    this.info = null;
    this.taken = null;
  }

  static override styles = [
    shared,
    css`
      form,
      .more {
        display: grid;
        gap: 1rem;
      }
      .more {
        margin-top: 1rem;
      }
      details summary {
        width: fit-content;
        font-size: 0.875rem;
        font-weight: 550;
        cursor: pointer;
      }
      .pair {
        display: grid;
        grid-template-columns: 1fr 1fr;
        gap: 0.75rem;
      }
      label,
      legend {
        display: block;
        padding: 0;
        font-size: 0.875rem;
        font-weight: 550;
      }
      .field {
        min-width: 0;
      }
      .box {
        display: flex;
        align-items: center;
        margin-top: 0.25rem;
        border: 1px solid var(--cusp-field);
        border-radius: 8px;
        background: var(--cusp-card);
      }
      .box:focus-within {
        outline: 3px solid var(--cusp-focus);
        outline-offset: 1px;
      }
      .box.wrong {
        border-color: var(--cusp-bad);
        box-shadow: inset 0 0 0 1px var(--cusp-bad);
      }
      input[type="text"],
      select {
        font: inherit;
        font-variant-numeric: tabular-nums;
        width: 100%;
        min-width: 0;
        min-height: 2.5rem;
        padding: 0.25rem 0.625rem;
        border: 0;
        border-radius: 8px;
        outline: none;
        background: transparent;
        color: inherit;
      }
      option {
        background: var(--cusp-card);
        color: var(--cusp-text);
      }
      .unit {
        padding-right: 0.625rem;
        color: var(--cusp-quiet);
        font-size: 0.875rem;
      }
      .hint,
      .fault {
        margin-top: 0.25rem;
        font-size: 0.8125rem;
        line-height: 1.4;
      }
      .hint {
        color: var(--cusp-quiet);
      }
      .fault {
        color: var(--cusp-bad);
      }
      .choice {
        display: grid;
        grid-template-columns: 1fr 1fr;
        margin-top: 0.25rem;
        border: 1px solid var(--cusp-field);
        border-radius: 8px;
        overflow: hidden;
      }
      .choice:focus-within:has(:focus-visible) {
        outline: 3px solid var(--cusp-focus);
        outline-offset: 1px;
      }
      .choice label {
        min-height: 2.5rem;
        display: grid;
        place-items: center;
        text-align: center;
        cursor: pointer;
      }
      .choice label:has(:checked) {
        background: var(--cusp-accent);
        color: var(--cusp-on-accent);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    // What the address changes must be seen; afterwards it is the reader who opens and closes.
    if (!changed.has("settings") || this.#moreAtFirst !== null) return;
    const { minimize, snap, step } = this.settings;
    this.#moreAtFirst =
      minimize !== DEFAULT_SETTINGS.minimize || snap !== DEFAULT_SETTINGS.snap || step !== DEFAULT_SETTINGS.step;
  }

  override render(): TemplateResult {
    const { settings, info } = this;
    const uniform = settings.planner === "uniform";
    return html`
      <form novalidate @submit=${(event: Event) => event.preventDefault()}>
        ${this.#radios("planner", "Layers", [["optimal", "Adaptive"], ["uniform", "Uniform"]], this.#plannerHint())}
        ${uniform ? this.#length("uniform", "Layer thickness") : nothing}
        ${this.#select(
          "metric",
          "Measure errors by",
          METRIC_NAMES.map((metric) => [metric, METRICS[metric].name]),
          METRICS[settings.metric].help,
        )}
        ${this.#tolerance()}
        <div class="pair">
          ${this.#length("layerMin", "Thinnest layer")} ${this.#length("layerMax", "Thickest layer")}
        </div>
        ${uniform ? html`<p class="hint">The range is what the uniform plan is compared with.</p>` : nothing}
        ${this.#length(
          "height",
          "Scale to height",
          info === null ? "Leave empty to keep the size." : `Leave empty for the file’s own ${format.size(info.size_mm[2])}\u00a0mm.`,
          info === null ? "" : format.size(info.size_mm[2]),
        )}
        ${this.#select(
          "rays",
          "Resolution",
          RAYS.map((rays) => [String(rays), `${format.count(rays)} pixels`]),
          "Along the longer side of the masks.",
        )}
        ${uniform ? nothing : this.#more()}
      </form>
    `;
  }

  #plannerHint(): string {
    const { planner, minimize } = this.settings;
    if (planner === "uniform") return "The same thickness all the way up.";
    return minimize === "time"
      ? "The shortest print that keeps the tolerance everywhere."
      : "The fewest layers that keep the tolerance everywhere.";
  }

  /** What only an adaptive plan has, and few people need. */
  #more(): TemplateResult {
    return html`<details ?open=${this.#moreAtFirst}>
      <summary>More settings</summary>
      <div class="more">
        ${this.#radios(
          "minimize",
          "Least",
          [["layers", "Layers"], ["time", "Print time"]],
          "Thick layers take longer to cure, so the fewest are not always the quickest.",
        )}
        ${this.#radios(
          "snap",
          "Planes at flats",
          [["auto", "On"], ["off", "Off"]],
          "Layers end where the model is flat, so that it prints at its true height.",
        )}
        ${this.#length("step", "Motor step", "Every height becomes a whole number of these. Leave empty if it is not known.")}
      </div>
    </details>`;
  }

  #tolerance(): TemplateResult {
    const { settings, taken } = this;
    const { metric, tolerances } = settings;
    const { unit, error } = METRICS[metric];
    const least = DEFAULTS.tolerance[metric];
    const hint =
      taken !== null && taken > least ? `The least that this model allows: ${error(least)} is not enough for it.` : "";
    const usual = usualTolerance(metric, taken);
    const change = (text: string): Partial<Settings> => withTolerance(settings, text);
    return this.#field("tolerance", "Tolerance", tolerances[metric] ?? usual, unit, hint, change, usual);
  }

  #length(field: Exclude<Field, "tolerance">, label: string, hint = "", placeholder = ""): TemplateResult {
    return this.#field(field, label, this.settings[field], "mm", hint, (text) => ({ [field]: text }), placeholder);
  }

  #field(
    field: Field,
    label: string,
    value: string,
    unit: string,
    hint: string,
    change: (text: string) => Partial<Settings>,
    placeholder = "",
  ): TemplateResult {
    const fault = this.faults[field];
    const described = fault !== undefined || hint !== "";
    return html`<div class="field">
      <label for=${field}>${label}</label>
      <div class="box ${fault === undefined ? "" : "wrong"}">
        <input
          type="text"
          inputmode="decimal"
          autocomplete="off"
          id=${field}
          placeholder=${placeholder}
          aria-invalid=${fault === undefined ? "false" : "true"}
          aria-describedby=${described ? `${field}-hint` : nothing}
          .value=${live(value)}
          @input=${(event: Event) => this.#say(change((event.target as HTMLInputElement).value))}
        /><span class="unit">${unit}</span>
      </div>
      ${described
        ? html`<p class=${fault === undefined ? "hint" : "fault"} id="${field}-hint">${fault ?? hint}</p>`
        : nothing}
    </div>`;
  }

  #select<Key extends "metric" | "rays">(
    key: Key,
    label: string,
    choices: readonly (readonly [Settings[Key], string])[],
    hint: string,
  ): TemplateResult {
    const chosen = this.settings[key];
    return html`<div class="field">
      <label for=${key}>${label}</label>
      <div class="box">
        <select
          id=${key}
          aria-describedby="${key}-hint"
          .value=${live(chosen)}
          @change=${(event: Event) => this.#say({ [key]: (event.target as HTMLSelectElement).value })}
        >
          ${choices.map(([value, name]) => html`<option value=${value} ?selected=${value === chosen}>${name}</option>`)}
        </select>
      </div>
      <p class="hint" id="${key}-hint">${hint}</p>
    </div>`;
  }

  #radios<Key extends "planner" | "minimize" | "snap">(
    key: Key,
    legend: string,
    choices: readonly (readonly [Settings[Key], string])[],
    hint: string,
  ): TemplateResult {
    return html`<fieldset aria-describedby="${key}-hint">
      <legend>${legend}</legend>
      <div class="choice">
        ${choices.map(
          ([value, name]) => html`<label>
            <input
              class="hidden"
              type="radio"
              name=${key}
              value=${value}
              .checked=${live(this.settings[key] === value)}
              @change=${() => this.#say({ [key]: value })}
            />${name}</label
          >`,
        )}
      </div>
      <p class="hint" id="${key}-hint">${hint}</p>
    </fieldset>`;
  }

  #say(patch: Partial<Settings>): void {
    this.dispatchEvent(new CustomEvent<Partial<Settings>>("cusp-settings", { detail: patch }));
  }
}

customElements.define("cusp-settings", CuspSettings);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-settings": CuspSettings;
  }
}
