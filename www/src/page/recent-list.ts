/**
 * `<cusp-recent>`: the work that this browser keeps, and the switch that permits it. Empty if the browser cannot keep any. Fires
 * `cusp-work` with the work to go on with, and `cusp-keeping` when keeping is switched on or off.
 */
import { css, html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { define } from "../element/define.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { elementWith, given, own } from "../view/properties.js";
import type { Snapshot } from "../element/state/snapshot.js";
import { icon } from "./icons.js";
import { isKeeping, setKeeping } from "./keeping.js";
import { MOST_BYTES, MOST_WORKS, PICTURE_PX, recentWorks, watchRecent, type RecentWork, type RecentWorks } from "./recent-work.js";
import { visitWords } from "./visit-texts.js";
import { visitStyles } from "./visit-styles.js";
import { shown } from "../api/visible.js";

const PROPERTIES = {
  language: given<Language>(languageOf()),
  works: own<RecentWorks | null>(null),
  list: own<readonly RecentWork[]>([]),
  said: own(""),
};

export class CuspRecent extends elementWith(PROPERTIES) {
  #unwatch: (() => void) | null = null;

  static override styles = [
    theme,
    shared,
    visitStyles,
    css`
      canvas {
        flex: none;
        width: 2.5rem;
        height: 2.5rem;
      }
      .row {
        gap: 0.625rem;
      }
      .row small {
        display: block;
        color: var(--cusp-quiet);
        font-size: 0.8125rem;
        font-weight: 400;
      }
      label {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        min-height: 2.25rem;
        font-weight: 550;
      }
      input {
        flex: none;
        width: 1.125rem;
        height: 1.125rem;
        margin: 0;
        accent-color: var(--cusp-accent);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.#unwatch = watchRecent(() => void this.#try(() => this.#read()));
    void this.#try(() => this.#read());
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#unwatch?.();
  }

  override render(): TemplateResult | typeof nothing {
    const { works, list, said } = this;
    if (works === null) return nothing;
    const { recent: words } = visitWords(this.language);
    const isOn = isKeeping();
    return html`<div class="panel">
      ${list.length > 0
        ? html`<ul>${list.map((it) => this.#row(it, works))}</ul>`
        : isOn
          ? html`<p class="about">${words.none}</p>`
          : nothing}
      ${this.#offer(works, isOn)}
      <p class="status" role="status">${said}</p>
    </div>`;
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("list")) void this.#draw();
  }

  #offer(works: RecentWorks, isOn: boolean): TemplateResult {
    const { language } = this;
    const { recent: words } = visitWords(language);
    const change = (): void => void this.#try(() => this.#switch(works, !isOn));
    return html`<div>
      <label><input type="checkbox" aria-describedby="about" .checked=${live(isOn)} @change=${change} />${words.keep}</label>
      <p class="about" id="about">${words.about({ works: language.format.count(MOST_WORKS), bytes: size(MOST_BYTES, language) })}</p>
    </div>`;
  }

  #row(it: RecentWork, works: RecentWorks): TemplateResult {
    const { bytes, changed_ms, id } = it;
    const name = nameOf(it, this.language);
    const { recent: words } = visitWords(this.language);
    const date = new Intl.DateTimeFormat(this.language.locale, { dateStyle: "medium", timeStyle: "short" }).format(changed_ms);
    return html`<li>
      <button class="row" @click=${() => void this.#try(() => this.#open(it, works))}>
        <canvas width=${PICTURE_PX} height=${PICTURE_PX} data-id=${id}></canvas>
        <span>${name}<small class="figures">${size(bytes, this.language)} · ${date}</small></span>
      </button>
      <button class="icon" aria-label=${words.delete({ name })} title=${words.delete({ name })} @click=${() => void this.#try(() => this.#delete(it, works))}>
        ${icon("delete")}
      </button>
    </li>`;
  }

  /** Runs work and reports a refusal by the browser's storage. */
  async #try(work: () => Promise<void>): Promise<void> {
    await work().catch(() => (this.said = visitWords(this.language).saved.failed));
  }

  async #open(it: RecentWork, works: RecentWorks): Promise<void> {
    const snapshot = await works.open(it).catch(() => null);
    if (snapshot !== null) {
      this.said = "";
      this.dispatchEvent(new CustomEvent<OpenedWork>("cusp-work", { detail: { id: it.id, snapshot } }));
      return;
    }
    this.said = visitWords(this.language).recent.gone({ name: nameOf(it, this.language) });
    await works.delete(it);
  }

  async #delete(it: RecentWork, works: RecentWorks): Promise<void> {
    const place = this.list.indexOf(it);
    await works.delete(it);
    this.said = visitWords(this.language).recent.deleted({ name: nameOf(it, this.language) });
    await this.#read();
    await this.updateComplete;
    // The button has gone, and the focus with it: focus the next work, or the switch.
    const buttons = this.renderRoot.querySelectorAll<HTMLElement>("li .icon");
    (buttons[Math.min(place, buttons.length - 1)] ?? this.renderRoot.querySelector("input"))?.focus();
  }

  async #switch(works: RecentWorks, isOn: boolean): Promise<void> {
    setKeeping(isOn);
    this.said = "";
    if (!isOn) {
      await works.deleteAll();
      this.said = visitWords(this.language).recent.allDeleted;
    }
    this.dispatchEvent(new CustomEvent("cusp-keeping"));
    await this.#read();
    this.requestUpdate();
  }

  async #read(): Promise<void> {
    this.works ??= await recentWorks();
    this.list = isKeeping() ? await (this.works?.list() ?? []) : [];
  }

  /** Draws pictures on canvases, since the page's policy forbids images from memory. */
  async #draw(): Promise<void> {
    const { works, list } = this;
    for (const it of list) {
      const png = await works?.picture(it).catch(() => null);
      const pen = this.renderRoot.querySelector<HTMLCanvasElement>(`canvas[data-id="${it.id}"]`)?.getContext("2d");
      pen?.clearRect(0, 0, PICTURE_PX, PICTURE_PX);
      if (png == null) continue;
      const picture = await createImageBitmap(png).catch(() => null);
      if (picture !== null) pen?.drawImage(picture, 0, 0, PICTURE_PX, PICTURE_PX);
      picture?.close();
    }
  }
}

/** Work to go on with, and its id among the recent. */
export interface OpenedWork {
  readonly id: string;
  readonly snapshot: Snapshot;
}

/** Name of the first model, with the number of the others. */
function nameOf({ work: { models } }: RecentWork, language: Language): string {
  const name = shown(models[0]?.name ?? "");
  return models.length < 2 ? name : visitWords(language).recent.more({ name, others: language.format.count(models.length - 1) });
}

const MEGABYTE = 1e6;

/** A human-readable size: `12.3 MB`. */
function size(bytes: number, { locale }: Language): string {
  const [unit, value] = bytes < MEGABYTE ? ["kilobyte", bytes / 1000] : ["megabyte", bytes / MEGABYTE];
  return new Intl.NumberFormat(locale, { style: "unit", unit, maximumSignificantDigits: 3 }).format(value).replace(" ", "\u00a0");
}

define("cusp-recent", CuspRecent);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-recent": CuspRecent;
  }
}
