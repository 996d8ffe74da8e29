/** A searchable list of printers, as an ARIA combobox: the field shows the chosen printer, and while it is open the text to search for. */
import { css, html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { KnownPrinter } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { COLLATOR } from "../state/printer.js";

/** An entry of the list. */
export interface Entry {
  readonly value: string;
  readonly name: string;
  /** Words on layers of several thicknesses on this printer; null for an entry that is no printer. */
  readonly layers: KnownPrinter["variable_layers"] | null;
  /** Source of that knowledge. */
  readonly source?: string | undefined;
}

/** The printers whose maker and model have all these words, the recent ones first. */
export function found(printers: readonly KnownPrinter[], text: string, recent: readonly string[]): Entry[] {
  const words = text.toLowerCase().split(/\s+/);
  const place = (name: string): number => (recent.includes(name) ? recent.indexOf(name) : recent.length);
  return printers
    .filter(({ model }) => words.every((word) => model.toLowerCase().includes(word)))
    .sort((a, b) => place(a.name) - place(b.name) || COLLATOR.compare(a.model, b.model))
    .map(({ name, model, variable_layers, variable_layers_source }) => ({ value: name, name: model, layers: variable_layers, source: variable_layers_source }));
}

/** State of an open list. */
export interface Search {
  readonly text: string;
  /** Index of the entry that Enter chooses. */
  readonly active: number;
}

export interface PrinterSearch {
  readonly search: Search | null;
  /** Name of the chosen printer. */
  readonly chosen: string;
  readonly value: string;
  readonly isFixed: boolean;
  readonly describedBy: string | null;
  readonly language: Language;
  /** The entries for the text of the search. */
  readonly entries: readonly Entry[];
  /** Opens the list, changes the search, or with null closes the list. */
  searches(search: Search | null): void;
  choose(value: string): void;
}

export function printerSearch({ search, chosen, value, isFixed, describedBy, language, entries, searches, choose }: PrinterSearch): TemplateResult {
  const words = language.texts.settings;
  const open = (): void => {
    if (search === null) searches({ text: "", active: -1 });
  };
  const moved = (by: number): void => {
    if (search === null) return open();
    const active = (search.active + by + entries.length) % Math.max(1, entries.length);
    searches({ ...search, active });
  };
  const pressed = (event: KeyboardEvent): void => {
    const { key } = event;
    if (key === "ArrowDown") moved(1);
    else if (key === "ArrowUp") moved(-1);
    else if (search === null) return;
    else if (key === "Escape") searches(null);
    else if (key === "Enter") {
      const entry = entries[search.active];
      if (entry === undefined) searches(null);
      else choose(entry.value);
    } else return;
    // Escape would also cancel the running task.
    event.stopPropagation();
    event.preventDefault();
  };
  return html`<div class="box list">
      <input
        id="printer"
        type="text"
        role="combobox"
        autocomplete="off"
        spellcheck="false"
        aria-autocomplete="list"
        aria-expanded=${search === null ? "false" : "true"}
        aria-controls=${search === null ? nothing : "printers"}
        aria-activedescendant=${search === null || search.active < 0 ? nothing : `printer-${search.active}`}
        aria-describedby=${describedBy ?? nothing}
        title=${chosen}
        placeholder=${search === null ? words.noPrinter : words.findPrinter}
        ?disabled=${isFixed}
        .value=${live(search === null ? chosen : search.text)}
        @click=${open}
        @input=${({ target }: Event) => searches({ text: (target as HTMLInputElement).value, active: 0 })}
        @keydown=${pressed}
        @blur=${() => searches(null)}
      />
    </div>
    ${search === null
      ? nothing
      : html`<ul id="printers" role="listbox" aria-label=${words.printer} @pointerdown=${(event: Event) => event.preventDefault()}>
          ${entries.map(
            ({ value: own, name, layers, source }, place) => html`<li
              id="printer-${place}"
              role="option"
              aria-selected=${own === value ? "true" : "false"}
              class=${place === search.active ? "active" : ""}
              @click=${() => choose(own)}
            >
              ${name}${layers === null ? nothing : html`<small class=${layers} title=${source ?? nothing}>${words.layersOf[layers]}</small>`}
            </li>`,
          )}
        </ul>`}`;
}

export const printerSearchStyles = css`
  [role="listbox"] {
    max-height: 18rem;
    margin: 0.25rem 0 0;
    padding: 0.25rem;
    overflow: auto;
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    list-style: none;
  }
  [role="option"] {
    padding: 0.375rem 0.5rem;
    border-radius: 6px;
    cursor: pointer;
  }
  .active {
    outline: 2px solid var(--cusp-focus);
  }
  [aria-selected="true"] {
    font-weight: 600;
  }
  small {
    display: block;
    color: var(--cusp-quiet);
    font-weight: 400;
  }
  .yes {
    color: var(--cusp-good);
  }
`;
