/**
 * Conveniences for visitors: the printer of the last visit, named settings, recent work, a short tour on the first visit, and the list of
 * keys. Only requested parts are fetched, except the tour.
 */
import { html, nothing, type TemplateResult } from "lit";
import { chosen } from "../element/parts/chosen.js";
import type { SlicerElement } from "../element/slicer-element.js";
import type { Snapshot } from "../element/state/snapshot.js";
import { fetchRest, languageOf, type Language } from "../texts/index.js";
import type { Autosave } from "./autosave.js";
import { closeFlyout, flyout } from "./flyout.js";
import { canKeep, hasKept, isKeeping } from "./keeping.js";
import type { Notice } from "./notice.js";
import { asksForKeys } from "./question-mark.js";
import type { OpenedWork } from "./recent-list.js";
import { remember } from "./remembered.js";
import { readKept, writeKept } from "./storage.js";
import { pageWords } from "./texts.js";
import type { Target } from "./tour.js";
import "./visit.css";

export interface VisitHost {
  /** Returns the element; called only after {@link Visit.start}. */
  element(): SlicerElement;
  /** URL of the current settings. */
  link(): string;
  open(files: readonly File[]): void;
  /** Goes on with earlier work. Returns false if that failed or was cancelled. */
  reopen(snapshot: Snapshot): Promise<boolean>;
  /** Redraws the page. */
  draw(): void;
  say(notice: Notice): void;
  /** Targets of the tour, one per step. */
  targets: readonly Target[];
  /** Height of fixed content at the bottom of the window, in CSS pixels. */
  clearance(): number;
}

export class Visit {
  readonly #host: VisitHost;
  #canKeep = canKeep();
  #autosave: Autosave | null = null;
  #arriving: Promise<void> | null = null;
  #language = languageOf();

  constructor(host: VisitHost) {
    this.#host = host;
  }

  /** Buttons for the header, with their panels. */
  tools(language: Language): TemplateResult {
    const words = pageWords(language);
    const { link } = this.#host;
    const tour = document.querySelector("cusp-tour");
    if (tour !== null) tour.language = language;
    this.#language = language;
    const saved = html`<cusp-saved .language=${language} .query=${this.#query} .link=${link} @cusp-apply=${this.#apply}></cusp-saved>`;
    const keys = html`<cusp-keys .language=${language} @cusp-tour=${() => void this.#asked(() => this.#tour())}></cusp-keys>`;
    return html`<div class="tools">
      ${this.#canKeep
        ? flyout({ id: "recent", label: words.recent, icon: "recent", content: this.#list(language), opening: () => void this.#asked(() => this.#fetchRecent(), "recent") })
        : nothing}
      ${flyout({ id: "saved", label: words.saved, icon: "saved", content: saved, opening: () => void this.#asked(() => this.#fetchSaved(), "saved") })}
      <button class="keys" aria-label=${words.keys} title=${words.keys} @click=${() => void this.#asked(() => this.#keys())}>?</button>
      ${keys}
    </div>`;
  }

  /** Recent work, for a page without a model; null if none is kept. */
  recent(language: Language): TemplateResult | null {
    if (!this.#canKeep || !hasKept()) return null;
    return html`<section class="recent">
      <h2>${pageWords(language).goOn}</h2>
      ${this.#list(language)}
    </section>`;
  }

  #list(language: Language): TemplateResult {
    const change = (): void => {
      this.#host.draw();
      this.#autosave?.changed();
    };
    return html`<cusp-recent .language=${language} @cusp-work=${this.#open} @cusp-keeping=${change}></cusp-recent>`;
  }

  /** Returns true if this browser has kept the open work as it is. */
  get isKept(): boolean {
    return this.#autosave?.isKept === true && isKeeping();
  }

  /** Starts the element, once in the page, with the settings of a URL. */
  start(asked: string): void {
    const element = this.#host.element();
    remember(element, asked);
    if (this.#canKeep) element.addEventListener("cusp-load", () => void (this.#arriving ??= this.#asked(() => this.#fetchAutosave())));
    element.addEventListener("cusp-plan", () => {
      // If nothing can be stored, every visit would look like the first, so the tour is not shown.
      if (readKept("tour") === null && writeKept("tour", "shown")) this.#tour().catch(() => undefined);
    });
    addEventListener("keydown", this.#key);
    if (this.#canKeep && hasKept()) void this.#asked(() => this.#fetchRecent());
  }

  /** Runs requested work whose code is fetched. If that fails, reports it and closes the empty flyout. */
  async #asked(work: () => Promise<void>, flyout?: string): Promise<void> {
    try {
      await work();
    } catch {
      if (flyout !== undefined) closeFlyout(flyout);
      this.#host.say({ says: "part" });
    }
  }

  readonly #key = (event: KeyboardEvent): void => {
    if (asksForKeys(event)) void this.#asked(() => this.#keys());
    else if ((event.ctrlKey || event.metaKey) && !event.shiftKey && !event.altKey && event.key.toLowerCase() === "o") this.#choose();
    else return;
    event.preventDefault();
  };

  /** Opens the browser's file dialog. */
  #choose(): void {
    const input = Object.assign(document.createElement("input"), { type: "file", multiple: true });
    input.addEventListener("change", (event) => this.#host.open(chosen(event)));
    input.click();
  }

  readonly #open = async ({ detail: { id, snapshot } }: CustomEvent<OpenedWork>): Promise<void> => {
    closeFlyout("recent");
    if (!(await this.#host.reopen(snapshot))) return;
    await this.#arriving;
    this.#autosave?.continues(id);
  };

  readonly #query = (): string => this.#host.element().query;

  readonly #apply = ({ detail }: CustomEvent<string>): void => {
    closeFlyout("saved");
    this.#host.element().query = detail;
  };

  /** Fetches what keeps the work, with the first model. */
  async #fetchAutosave(): Promise<void> {
    const { Autosave } = await import("./autosave.js");
    this.#autosave = new Autosave(this.#host.element(), (name) => this.#host.say({ says: "notKept", name }));
    this.#autosave.changed();
  }

  async #fetchRecent(): Promise<void> {
    await fetchRest();
    const [{ recentWorks }] = await Promise.all([import("./recent-work.js"), import("./recent-list.js")]);
    if ((await recentWorks()) !== null) return;
    this.#canKeep = false;
    this.#host.draw();
  }

  async #fetchSaved(): Promise<void> {
    await fetchRest();
    await import("./saved-list.js");
    // The current settings may have changed since the list was last open, and with them the marked entry.
    document.querySelector("cusp-saved")?.requestUpdate();
  }

  async #keys(): Promise<void> {
    await fetchRest();
    await import("./keys.js");
    const list = document.querySelector("cusp-keys");
    if (list === null) return;
    list.hasTour = this.#host.element().result !== null;
    await list.show();
  }

  /** Shows the tour, unless it is already shown. */
  async #tour(): Promise<void> {
    const [{ CuspTour }] = await Promise.all([import("./tour.js"), fetchRest()]);
    if (document.querySelector("cusp-tour") !== null) return;
    const { targets, clearance, element } = this.#host;
    await element().updateComplete;
    document.body.prepend(Object.assign(new CuspTour(), { targets, clearance, language: this.#language }));
  }
}
