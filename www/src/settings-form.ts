/** The settings as a form. It holds nothing: it shows what it is given and says what was typed. */
import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import * as format from "./format.js";
import { RAYS, type Faults, type Field, type Settings } from "./settings.js";
import { shared } from "./styles.js";
import type { MeshInfo } from "./wire.js";

export class CuspSettings extends LitElement {
  static override properties = {
    settings: { attribute: false },
    faults: { attribute: false },
    info: { attribute: false },
  };

  declare settings: Settings;
  declare faults: Faults;
  declare info: MeshInfo | null;

  constructor() {
    super();
    this.faults = {};
    this.info = null;
  }

  static override styles = [
    shared,
    css`
      form {
        display: grid;
        gap: 1rem;
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

  override render(): TemplateResult {
    const { settings, info } = this;
    const uniform = settings.planner === "uniform";
    return html`
      <form novalidate @submit=${(event: Event) => event.preventDefault()}>
        <fieldset>
          <legend>Layers</legend>
          <div class="choice">
            ${this.#radio("optimal", "Adaptive")} ${this.#radio("uniform", "Uniform")}
          </div>
          <p class="hint">
            ${uniform ? "The same thickness all the way up." : "The fewest layers that keep the tolerance everywhere."}
          </p>
        </fieldset>
        ${uniform ? this.#length("uniform", "Layer thickness") : nothing}
        ${this.#length("tolerance", "Tolerance", "The largest step (cusp error) that a layer may leave on the surface.")}
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
        <div class="field">
          <label for="rays">Resolution</label>
          <div class="box">
            <select id="rays" aria-describedby="rays-hint" .value=${live(settings.rays)} @change=${this.#typed("rays")}>
              ${RAYS.map(
                (rays) => html`<option value=${rays} ?selected=${String(rays) === settings.rays}>
                  ${format.count(rays)} pixels
                </option>`,
              )}
            </select>
          </div>
          <p class="hint" id="rays-hint">Along the longer side of the masks.</p>
        </div>
      </form>
    `;
  }

  #radio(value: Settings["planner"], label: string): TemplateResult {
    return html`<label>
      <input
        class="hidden"
        type="radio"
        name="planner"
        value=${value}
        .checked=${live(this.settings.planner === value)}
        @change=${() => this.#say({ planner: value })}
      />${label}</label
    >`;
  }

  #length(field: Field, label: string, hint = "", placeholder = ""): TemplateResult {
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
          .value=${live(this.settings[field])}
          @input=${this.#typed(field)}
        /><span class="unit">mm</span>
      </div>
      ${described
        ? html`<p class=${fault === undefined ? "hint" : "fault"} id="${field}-hint">${fault ?? hint}</p>`
        : nothing}
    </div>`;
  }

  #typed(field: Field): (event: Event) => void {
    return (event) => {
      const { value } = event.target as HTMLInputElement | HTMLSelectElement;
      this.#say({ [field]: value });
    };
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
