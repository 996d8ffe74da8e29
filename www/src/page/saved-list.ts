/**
 * `<cusp-saved>`: named settings to apply, save, rename and delete, and a link to the current ones. Its host provides `query`, which
 * returns the current settings, and `link`, which returns their URL. Fires `cusp-apply` with the query to apply.
 */
import { css, html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { define } from "../element/define.js";
import { saveFile } from "../element/parts/save-file.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { elementWith, given, own } from "../view/properties.js";
import { icon } from "./icons.js";
import { appliedTo, isNamed, LONGEST_NAME, savedIn, savedQuery, withoutSaved, withSaved, type SavedSettings } from "./saved-settings.js";
import { FILE_NAME, settingsFile } from "./settings-file.js";
import { readKept, writeKept } from "./storage.js";
import { visitWords } from "./visit-texts.js";
import { visitStyles } from "./visit-styles.js";

/** The last message, and the list to restore if it can be undone. */
interface Said {
  text: string;
  before?: readonly SavedSettings[];
}

const PROPERTIES = {
  query: given((): string => ""),
  link: given((): string => ""),
  language: given<Language>(languageOf()),
  list: own<readonly SavedSettings[]>([]),
  /** Text of the field for a new name. */
  typed: own(""),
  /** The name being changed, and the text of its field. */
  renamed: own<{ from: string; to: string } | null>(null),
  said: own<Said | null>(null),
  /** A link that the browser refused to copy. */
  shown: own<string | null>(null),
};

export class CuspSaved extends elementWith(PROPERTIES) {
  static override styles = [
    theme,
    shared,
    visitStyles,
    css`
      .row svg {
        visibility: hidden;
        flex: none;
        width: 1rem;
        height: 1rem;
        fill: none;
        stroke: currentColor;
        stroke-width: 2;
      }
      .row[aria-current="true"] svg {
        visibility: visible;
      }
      form:not(.line) {
        display: grid;
        gap: 0.25rem;
      }
      label {
        font-weight: 550;
      }
      li form {
        flex: 1;
      }
      .link-part {
        padding-top: 0.75rem;
        border-top: 1px solid var(--cusp-line);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.#read();
    addEventListener("storage", this.#read);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("storage", this.#read);
  }

  override render(): TemplateResult {
    const { list, typed, said, shown } = this;
    const { saved: words } = visitWords(this.language);
    const save = (event: Event): void => {
      event.preventDefault();
      const name = typed.trim();
      if (name === "" || !this.#write(withSaved(this.#fresh(), { name, query: savedQuery(this.query()) }), { text: words.saved({ name }) })) return;
      this.typed = "";
    };
    return html`<div class="panel">
      ${list.length === 0 ? html`<p class="about">${words.none}</p>` : html`<ul>${list.map((it) => this.#row(it))}</ul>`}
      <form @submit=${save}>
        <label for="name">${words.name}</label>
        <div class="line">
          <input
            id="name"
            type="text"
            autocomplete="off"
            maxlength=${LONGEST_NAME}
            .value=${live(typed)}
            @input=${({ target }: Event) => (this.typed = (target as HTMLInputElement).value)}
          /><button class="small" ?disabled=${typed.trim() === ""}>
            ${list.some(({ name }) => isNamed(name, typed)) ? words.replace : words.save}
          </button>
        </div>
        <p class="about">${words.about}</p>
      </form>
      <p class="status" role="status">${said === null ? nothing : html`${said.text} ${this.#undo(said)}`}</p>
      <div class="link-part panel">
        <button class="small" @click=${this.#copy}>${words.copyLink}</button>
        ${shown === null
          ? nothing
          : html`<label>${words.copyByHand}<input type="text" readonly .value=${shown} @focus=${selected} /></label>`}
        <button class="small" aria-describedby="file" ?disabled=${settingsFile(this.query()) === null} @click=${this.#save}>${words.toFile}</button>
        <p class="about" id="file">${words.aboutFile}</p>
      </div>
    </div>`;
  }

  #row({ name, query }: SavedSettings): TemplateResult {
    const { saved: words } = visitWords(this.language);
    const { renamed } = this;
    if (renamed?.from === name) return html`<li>${this.#renaming(renamed, query)}</li>`;
    return html`<li>
      <button class="row" aria-current=${query === savedQuery(this.query())} @click=${() => this.#apply(query)}>
        ${icon("applied")}<span>${name}</span>
      </button>
      <button class="icon" data-name=${name} aria-label=${words.rename({ name })} title=${words.rename({ name })} @click=${() => void this.#rename(name)}>
        ${icon("rename")}
      </button>
      <button class="icon" aria-label=${words.delete({ name })} title=${words.delete({ name })} @click=${() => void this.#delete(name)}>
        ${icon("delete")}
      </button>
    </li>`;
  }

  #renaming({ from, to }: { from: string; to: string }, query: string): TemplateResult {
    const { saved: words } = visitWords(this.language);
    const isTaken = !isNamed(from, to) && this.list.some(({ name }) => isNamed(name, to));
    const finish = async (event: Event): Promise<void> => {
      event.preventDefault();
      const name = to.trim();
      if (name === "") return;
      this.renamed = null;
      this.#write(withSaved(withoutSaved(this.#fresh(), from), { name, query }), { text: words.saved({ name }) });
      await this.#focus(`[data-name="${CSS.escape(name)}"]`);
    };
    const key = (event: KeyboardEvent): void => {
      if (event.key !== "Escape") return;
      // Escape ends the renaming only.
      event.preventDefault();
      event.stopPropagation();
      this.renamed = null;
      void this.#focus(`[data-name="${CSS.escape(from)}"]`);
    };
    return html`<form class="line" @submit=${(event: Event) => void finish(event)} @keydown=${key}>
      <input
        id="rename"
        type="text"
        autocomplete="off"
        maxlength=${LONGEST_NAME}
        aria-label=${words.rename({ name: from })}
        .value=${live(to)}
        @input=${({ target }: Event) => (this.renamed = { from, to: (target as HTMLInputElement).value })}
      /><button class="small">${isTaken ? words.replace : words.save}</button>
    </form>`;
  }

  #undo({ before }: Said): TemplateResult | typeof nothing {
    if (before === undefined) return nothing;
    return html`<button class="link" id="undo" @click=${() => this.#write(before, null)}>${visitWords(this.language).saved.undo}</button>`;
  }

  #apply(query: string): void {
    this.said = null;
    this.dispatchEvent(new CustomEvent<string>("cusp-apply", { detail: appliedTo(this.query(), query) }));
  }

  async #rename(name: string): Promise<void> {
    this.renamed = { from: name, to: name };
    (await this.#focus("#rename") as HTMLInputElement | null)?.select();
  }

  async #delete(name: string): Promise<void> {
    const before = this.#fresh();
    this.#write(withoutSaved(before, name), { text: visitWords(this.language).saved.deleted({ name }), before });
    // The button has gone, and the focus with it.
    await this.#focus("#undo");
  }

  readonly #copy = async (): Promise<void> => {
    const link = this.link();
    try {
      await navigator.clipboard.writeText(link);
      this.shown = null;
      this.said = { text: visitWords(this.language).saved.copied };
    } catch {
      this.shown = link;
      await this.#focus("[readonly]");
    }
  };

  readonly #save = (): void => {
    const text = settingsFile(this.query());
    if (text === null) return;
    saveFile({ name: FILE_NAME, blob: new Blob([text], { type: "application/toml" }) });
    this.said = { text: visitWords(this.language).saved.inFile };
  };

  async #focus(selector: string): Promise<HTMLElement | null> {
    await this.updateComplete;
    const found = this.renderRoot.querySelector<HTMLElement>(selector);
    found?.focus();
    return found;
  }

  /** The current list, which another tab may have changed. */
  #fresh(): SavedSettings[] {
    return savedIn(readKept("settings"));
  }

  readonly #read = (): void => {
    this.list = this.#fresh();
  };

  #write(list: readonly SavedSettings[], said: Said | null): boolean {
    const isKept = writeKept("settings", JSON.stringify(list));
    this.said = isKept ? said : { text: visitWords(this.language).saved.failed };
    this.#read();
    return isKept;
  }
}

function selected({ target }: Event): void {
  (target as HTMLInputElement).select();
}

define("cusp-saved", CuspSaved);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-saved": CuspSaved;
  }
}
