/**
 * `<cusp-recent>`: the models that this browser keeps, and the switch that permits it. Empty if the browser cannot keep any. Fires
 * `cusp-files` with the file of a model to open, and `cusp-keeping` when keeping is switched on or off.
 */
import { css, html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { define } from "../element/define.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { elementWith, given, own } from "../view/properties.js";
import { icon } from "./icons.js";
import { isKeeping, setKeeping } from "./keeping.js";
import { MOST_BYTES, MOST_MODELS, PICTURE_PX, recentModels, watchRecent, type RecentModel, type RecentModels } from "./recent-models.js";
import { visitWords } from "./visit-texts.js";
import { visitStyles } from "./visit-styles.js";
import { shown } from "../api/visible.js";

const PROPERTIES = {
  language: given<Language>(languageOf()),
  /** True to omit the switch. */
  bare: given(false),
  models: own<RecentModels | null>(null),
  list: own<readonly RecentModel[]>([]),
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
    const { models, list, said } = this;
    if (models === null) return nothing;
    const { recent: words } = visitWords(this.language);
    const isOn = isKeeping();
    return html`<div class="panel">
      ${list.length > 0
        ? html`<ul>${list.map((it) => this.#row(it, models))}</ul>`
        : isOn
          ? html`<p class="about">${words.none}</p>`
          : nothing}
      ${this.bare ? nothing : this.#offer(models, isOn)}
      <p class="status" role="status">${said}</p>
    </div>`;
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("list")) void this.#draw();
  }

  #offer(models: RecentModels, isOn: boolean): TemplateResult {
    const { language } = this;
    const { recent: words } = visitWords(language);
    const change = (): void => void this.#try(() => this.#switch(models, !isOn));
    return html`<div>
      <label><input type="checkbox" aria-describedby="about" .checked=${live(isOn)} @change=${change} />${words.keep}</label>
      <p class="about" id="about">${words.about({ models: language.format.count(MOST_MODELS), bytes: size(MOST_BYTES, language) })}</p>
    </div>`;
  }

  #row(model: RecentModel, models: RecentModels): TemplateResult {
    const { bytes, opened_ms, id } = model;
    const name = shown(model.name);
    const { recent: words } = visitWords(this.language);
    const date = new Intl.DateTimeFormat(this.language.locale, { dateStyle: "medium" }).format(opened_ms);
    return html`<li>
      <button class="row" @click=${() => void this.#try(() => this.#open(model, models))}>
        <canvas width=${PICTURE_PX} height=${PICTURE_PX} data-id=${id}></canvas>
        <span>${name}<small class="figures">${size(bytes, this.language)} · ${date}</small></span>
      </button>
      <button class="icon" aria-label=${words.delete({ name })} title=${words.delete({ name })} @click=${() => void this.#try(() => this.#delete(model, models))}>
        ${icon("delete")}
      </button>
    </li>`;
  }

  /** Runs work and reports a refusal by the browser's storage. */
  async #try(work: () => Promise<void>): Promise<void> {
    await work().catch(() => (this.said = visitWords(this.language).saved.failed));
  }

  async #open(model: RecentModel, models: RecentModels): Promise<void> {
    const file = await models.open(model).catch(() => null);
    if (file !== null) {
      this.said = "";
      this.dispatchEvent(new CustomEvent<File[]>("cusp-files", { detail: [file] }));
      return;
    }
    this.said = visitWords(this.language).recent.gone({ name: shown(model.name) });
    await models.delete(model);
  }

  async #delete(model: RecentModel, models: RecentModels): Promise<void> {
    const place = this.list.indexOf(model);
    await models.delete(model);
    this.said = visitWords(this.language).recent.deleted({ name: shown(model.name) });
    await this.#read();
    await this.updateComplete;
    // The button has gone, and the focus with it: focus the next model, or the switch.
    const buttons = this.renderRoot.querySelectorAll<HTMLElement>("li .icon");
    (buttons[Math.min(place, buttons.length - 1)] ?? this.renderRoot.querySelector("input"))?.focus();
  }

  async #switch(models: RecentModels, isOn: boolean): Promise<void> {
    setKeeping(isOn);
    this.said = "";
    if (!isOn) {
      await models.deleteAll();
      this.said = visitWords(this.language).recent.allDeleted;
    }
    this.dispatchEvent(new CustomEvent("cusp-keeping"));
    await this.#read();
    this.requestUpdate();
  }

  async #read(): Promise<void> {
    this.models ??= await recentModels();
    this.list = isKeeping() ? await (this.models?.list() ?? []) : [];
  }

  /** Draws pictures on canvases, since the page's policy forbids images from memory. */
  async #draw(): Promise<void> {
    const { models, list } = this;
    for (const model of list) {
      const png = await models?.picture(model).catch(() => null);
      const pen = this.renderRoot.querySelector<HTMLCanvasElement>(`canvas[data-id="${model.id}"]`)?.getContext("2d");
      pen?.clearRect(0, 0, PICTURE_PX, PICTURE_PX);
      if (png == null) continue;
      const picture = await createImageBitmap(png).catch(() => null);
      if (picture !== null) pen?.drawImage(picture, 0, 0, PICTURE_PX, PICTURE_PX);
      picture?.close();
    }
  }
}

const MEGABYTE = 1e6;

/** A human-readable size: `12.3 MB`. */
function size(bytes: number, { locale }: Language): string {
  const [unit, value] = bytes < MEGABYTE / 10 ? ["kilobyte", bytes / 1000] : ["megabyte", bytes / MEGABYTE];
  return new Intl.NumberFormat(locale, { style: "unit", unit, maximumSignificantDigits: 3 }).format(value).replace(" ", "\u00a0");
}

define("cusp-recent", CuspRecent);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-recent": CuspRecent;
  }
}
