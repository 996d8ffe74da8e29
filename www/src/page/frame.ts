/** The markup of the page: header, element, and the content of its slots. */
import { html, nothing, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { KnownPrinter, Printer } from "../api/wire.js";
import { chosen } from "../element/parts/chosen.js";
import { LANGUAGE_NAMES, LANGUAGES, type Language } from "../texts/index.js";
import icon from "./icon.svg";
import { noticeBar, type Notice } from "./notice.js";
import { pageWords } from "./texts.js";
import type { Visit } from "./visit.js";

export interface PageActions {
  example(): void;
  speak(locale: string): void;
  /** Opens files that the user chose. */
  open(files: readonly File[]): void;
  saveProject(): void;
  /** Closes the notice. */
  dismiss(): void;
}

/** A print file shown in place of the slicer. */
export interface PrintOnShow {
  file: File;
  /** Printers that files may name. */
  printers: readonly KnownPrinter[];
  /** Chooses the printer of the file. */
  use(printer: string | Printer): void;
  close(): void;
  /** Called if the file is not a print file. */
  unknown(): void;
  /** Called if the reader could not be loaded. */
  missing(): void;
}

export function frame(
  language: Language,
  { example, speak, open, saveProject, dismiss }: PageActions,
  { print, notice }: { print: PrintOnShow | null; notice: Notice | null },
  visit: Visit,
): TemplateResult {
  const { code, locale } = language;
  const words = pageWords(language);
  return html`
    <header>
      <div class="brand">
        <img src=${icon} alt="" width="32" height="32" />
        <h1>Cusp</h1>
      </div>
      <p class="private">${words.private}</p>
      ${visit.tools(language)}
      <label class="language">
        <span class="hidden">${words.languages}</span>
        <select .value=${live(code)} @change=${(event: Event) => speak((event.target as HTMLSelectElement).value)}>
          ${LANGUAGES.map(
            (it) => html`<option value=${it} lang=${it} ?selected=${it === code}>${LANGUAGE_NAMES[it]}</option>`,
          )}
        </select>
      </label>
    </header>
    <main>
      ${print === null
        ? nothing
        : html`<cusp-print
            .file=${print.file}
            .language=${language}
            .printers=${print.printers}
            @cusp-printer=${(event: CustomEvent<string | Printer>) => print.use(event.detail)}
            @cusp-close=${print.close}
            @cusp-unknown=${print.unknown}
            @cusp-missing=${print.missing}
            @cusp-files=${(event: CustomEvent<File[]>) => open(event.detail)}
          ></cusp-print>`}
      <cusp-workbench .locale=${locale} ?hidden=${print !== null}>
        <div slot="start" class="first">
          <h2>${words.headline}</h2>
          <p class="lead">${words.lead}</p>
          <label class="drop" part="drop">
            <input class="hidden" type="file" multiple @change=${(event: Event) => open(chosen(event))} />
            <strong>${language.texts.open.drop}</strong>
            <span class="choose">${language.texts.open.choose}</span>
            <small>${words.files}</small>
          </label>
        </div>
        <p slot="offers" class="offers">
          <button class="link" @click=${example}>${words.tryExample}</button>
          <span class="private phone">${words.private}</span>
        </p>
        <div slot="beside" class="beside">${visit.recent(language) ?? html`<cusp-figure aria-hidden="true"></cusp-figure>`}</div>
        <button slot="actions" class="link" @click=${saveProject}>${words.saveProject}</button>
      </cusp-workbench>
    </main>
    ${notice === null ? nothing : noticeBar(notice, words, dismiss)}
    <div class="drop-veil"><p class="open">${words.drop}</p><p class="add">${words.dropAdd}</p><p class="replace">${words.dropReplace}</p></div>
  `;
}
