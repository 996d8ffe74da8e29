/** `<cusp-keys>`: the list of the page's keys, a dialog. It fires `cusp-tour` when the user requests the tour. */
import { css, html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { define } from "../element/define.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { viewingTexts } from "../texts/viewing.js";
import { elementWith, given } from "../view/properties.js";
import { caps, KEY_TABLE, type Place, type Row } from "./key-table.js";
import { hasQuestionMark, setQuestionMark } from "./question-mark.js";
import { visitWords } from "./visit-texts.js";

const PROPERTIES = {
  language: given<Language>(languageOf()),
  /** True if there is a plan, which the tour needs. */
  hasTour: given(false),
};

export class CuspKeys extends elementWith(PROPERTIES) {
  static override styles = [
    theme,
    shared,
    css`
      :host {
        display: contents;
      }
      dialog {
        width: min(54rem, 100vw - 1rem);
        max-height: calc(100dvh - 1rem);
        padding: 0;
        border: 1px solid var(--cusp-line);
        border-radius: var(--cusp-radius);
        background: var(--cusp-card);
        color: inherit;
        font-size: 0.875rem;
      }
      dialog[open] {
        display: grid;
        grid-template-rows: auto minmax(0, 1fr) auto;
      }
      .head,
      .foot {
        margin: 0;
        padding: 0.75rem 1.25rem;
      }
      dialog::backdrop {
        background: rgb(0 0 0 / 0.4);
      }
      h2 {
        font-size: 1.125rem;
        font-weight: 600;
      }
      .groups {
        columns: 19rem 2;
        column-gap: 2rem;
      }
      .scroller {
        padding: 0 1.25rem;
        overflow: auto;
      }
      .scroller:focus-visible {
        outline-offset: -3px;
      }
      section {
        break-inside: avoid;
        padding-bottom: 1rem;
      }
      h3 {
        margin-bottom: 0.25rem;
      }
      dl div {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
        gap: 0.75rem;
        padding-block: 0.1875rem;
        border-top: 1px solid var(--cusp-line);
      }
      dt {
        display: flex;
        flex-wrap: wrap;
        align-items: start;
        align-content: start;
        gap: 0.25rem 0.5rem;
      }
      dt span {
        display: inline-flex;
        gap: 0.1875rem;
      }
      kbd {
        min-width: 1.5rem;
        padding: 0 0.3125rem;
        border: 1px solid var(--cusp-field);
        border-radius: 4px;
        font: inherit;
        font-size: 0.8125rem;
        line-height: 1.375rem;
        text-align: center;
        white-space: nowrap;
      }
      .foot {
        padding-block: 0.5rem;
        border-top: 1px solid var(--cusp-line);
      }
      label {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        min-height: 2.25rem;
      }
      input {
        width: 1.125rem;
        height: 1.125rem;
        margin: 0;
        accent-color: var(--cusp-accent);
      }
    `,
  ];

  override render(): TemplateResult {
    const { language, hasTour } = this;
    const { keys: words } = visitWords(language);
    const titles: Readonly<Record<Place, string>> = { ...words, ...viewingTexts(language).hints };
    const isOn = hasQuestionMark();
    return html`<dialog aria-labelledby="title" @keydown=${kept} @click=${this.#clicked}>
      <div class="head">
        <h2 id="title">${words.title}</h2>
        <button class="small" @click=${() => this.#dialog.close()}>${words.close}</button>
      </div>
      <div class="scroller" tabindex="0" role="group" aria-labelledby="title">
        <div class="groups">
          ${KEY_TABLE.map(
            ([place, rows]) => html`<section>
              <h3>${titles[place]}</h3>
              <dl>${rows.map((row) => keyRow(row, words))}</dl>
            </section>`,
          )}
        </div>
      </div>
      <div class="foot">
        <label>
          <input type="checkbox" .checked=${live(isOn)} @change=${() => this.#switch(!isOn)} />${words.questionMark}
        </label>
        ${hasTour ? html`<button class="small" @click=${this.#tour}>${words.tour}</button>` : nothing}
      </div>
    </dialog>`;
  }

  async show(): Promise<void> {
    await this.updateComplete;
    if (!this.#dialog.open) this.#dialog.showModal();
  }

  get #dialog(): HTMLDialogElement {
    const dialog = this.renderRoot.querySelector("dialog");
    if (dialog === null) throw new Error("the list of keys has no dialog");
    return dialog;
  }

  #switch(isOn: boolean): void {
    setQuestionMark(isOn);
    this.requestUpdate();
  }

  readonly #tour = (): void => {
    this.#dialog.close();
    this.dispatchEvent(new CustomEvent("cusp-tour"));
  };

  /** Closes the dialog on a click outside. */
  readonly #clicked = (event: MouseEvent): void => {
    if (event.target !== this.#dialog) return;
    const { left, right, top, bottom } = this.#dialog.getBoundingClientRect();
    const { clientX: x, clientY: y } = event;
    if (x < left || x > right || y < top || y > bottom) this.#dialog.close();
  };
}

/** While the dialog is open, it receives all keys: Escape closes it and cancels no task. */
function kept(event: KeyboardEvent): void {
  event.stopPropagation();
}

const isMac = (): boolean => /Mac|iP/.test(navigator.platform);

function keyRow([does, keys, held]: Row, { does: sentences, names }: ReturnType<typeof visitWords>["keys"]): TemplateResult {
  const cap = (key: string): TemplateResult => html`<kbd>${key}</kbd>`;
  const all = held === undefined ? keys : [held, ...keys];
  return html`<div>
    <dt>${all.map((key) => html`<span>${caps(key, names, isMac()).map(cap)}</span> `)}</dt>
    <dd>${sentences[does]}</dd>
  </div>`;
}

define("cusp-keys", CuspKeys);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-keys": CuspKeys;
  }
}
