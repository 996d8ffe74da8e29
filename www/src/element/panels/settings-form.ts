/** The settings as a form. It keeps no settings: it shows those that it is given, and reports what is typed. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { DEFAULTS, type Format, type MeshInfo } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { formatFor } from "../state/choice.js";
import { METRIC_NAMES, METRICS } from "../state/metric.js";
import type { Choice, Problem } from "../state/problem.js";
import { problemBox, problemStyles } from "../parts/problem-box.js";
import { DEFAULT_SETTINGS, faultWords, FORMATS, RAYS, usualTolerance, withTolerance } from "../state/settings.js";
import type { Faults, Field, Offered, Settings } from "../state/settings.js";
import { settingsStyles } from "../styles/settings-styles.js";
import { shared } from "../styles/shared.js";
import { elementWith, given } from "../../view/properties.js";

/** Settings that are hidden at first, unless one differs from its default. */
const MORE = ["minimize", "snap", "step", "exposure", "bottomExposure", "bottomLayers"] as const;

/** Whether the form shows the field of a problem, so that the problem can be shown beside it. */
export function hasPlace({ field }: Problem, { printer }: Settings, { printers }: Offered): boolean {
  if (field === null) return false;
  if (field === "printer") return printers.length > 0;
  return field !== "rays" || printer === "";
}

const PROPERTIES = {
  settings: given(DEFAULT_SETTINGS),
  faults: given<Faults>({}),
  info: given<MeshInfo | null>(null),
  /** The tolerance that the core chose because none is typed; null if unknown. */
  taken: given<number | null>(null),
  offered: given<Offered>({ printers: [], resins: [] }),
  /** Settings that are shown read-only. */
  fixed: given<ReadonlySet<keyof Settings>>(new Set()),
  /** A failure that one of these settings caused, to be shown beside that setting. */
  problem: given<Problem | null>(null),
  language: given(languageOf()),
};

export class CuspSettings extends elementWith(PROPERTIES) {
  /** Whether the hidden settings are expanded at first; null before any settings are given. */
  #moreAtFirst: boolean | null = null;

  static override styles = [shared, problemStyles, settingsStyles];

  override willUpdate(changed: PropertyValues<this>): void {
    // Settings changed by the URL must be visible. After that, the user expands and collapses them.
    if (!changed.has("settings") || this.#moreAtFirst !== null) return;
    this.#moreAtFirst = MORE.some((key) => this.settings[key] !== DEFAULT_SETTINGS[key]);
  }

  override render(): TemplateResult {
    const { settings, info, offered } = this;
    const { texts, format } = this.language;
    const words = texts.settings;
    const isUniform = settings.planner === "uniform";
    const own = info === null ? "" : format.size(info.size_mm[2]);
    return html`
      <form novalidate @submit=${(event: Event) => event.preventDefault()}>
        ${this.#radios("planner", words.layers, [["optimal", words.adaptive], ["uniform", words.uniform]], this.#plannerHint())}
        ${isUniform ? this.#length("uniform", words.thickness) : nothing}
        ${this.#select(
          "metric",
          words.metric,
          METRIC_NAMES.map((metric) => [metric, texts.metrics[metric].name]),
          texts.metrics[settings.metric].help,
        )}
        ${this.#tolerance()}
        <div class="pair">${this.#length("layerMin", words.thinnest)} ${this.#length("layerMax", words.thickest)}</div>
        ${isUniform ? html`<p class="hint">${words.rangeHint}</p>` : nothing}
        ${this.#length("height", words.height, info === null ? words.heightHint : words.heightOwn(`${own}\u00a0mm`), own)}
        ${offered.printers.length === 0 ? nothing : this.#printer()}
        ${settings.printer === ""
          ? this.#select(
              "rays",
              words.resolution,
              RAYS.map((rays) => [String(rays), words.pixels(format.count(rays))]),
              words.resolutionHint,
            )
          : nothing}
        ${this.#select(
          "format",
          words.format,
          [
            ...(settings.printer === "" ? [] : [["", words.formatUsual] as const]),
            ...FORMATS.map((format) => [format, words.formats[format]] as const),
          ],
          this.#file === "sl1" && !isUniform ? words.formatUniform : "",
          settings.format === "" && settings.printer === "" ? "png" : settings.format,
        )}
        ${offered.resins.length === 0
          ? nothing
          : this.#select(
              "resin",
              words.resin,
              [["", words.resinUsual], ...offered.resins.map(({ name = "" }) => [name, name] as const)],
            )}
        ${this.#more(isUniform)}
      </form>
    `;
  }

  /** The print format that these settings give. */
  get #file(): Format {
    const { printer, format } = this.settings;
    return formatFor({ printer, format }, this.offered.printers);
  }

  #plannerHint(): string {
    const { planner, minimize } = this.settings;
    const words = this.language.texts.settings;
    if (planner === "uniform") return words.uniformHint;
    return minimize === "time" ? words.quickestHint : words.fewestHint;
  }

  #printer(): TemplateResult {
    const { settings, offered, language } = this;
    const { texts, format } = language;
    const chosen = offered.printers.find(({ name }) => name === settings.printer);
    const hint =
      chosen === undefined
        ? ""
        : texts.settings.printerHint(
            chosen.pixels.map(format.count).join(" × "),
            `${[...new Set(chosen.pitch_um)].map(format.tick).join(" × ")}\u00a0µm`,
            format.dimensions(chosen.volume_mm),
          );
    const models = offered.printers.map(({ name, model }) => [name, model] as const);
    return this.#select("printer", texts.settings.printer, [["", texts.settings.noPrinter], ...models], hint);
  }

  /** Settings that few users need. */
  #more(isUniform: boolean): TemplateResult {
    const words = this.language.texts.settings;
    return html`<details ?open=${this.#moreAtFirst}>
      <summary>${words.more}</summary>
      <div class="more">
        ${isUniform
          ? nothing
          : html`${this.#radios("minimize", words.least, [["layers", words.leastLayers], ["time", words.leastTime]], words.leastHint)}
            ${this.#radios("snap", words.flats, [["auto", words.on], ["off", words.off]], words.flatsHint)}
            ${this.#length("step", words.step, words.stepHint)}`}
        ${this.#typed("exposure", words.exposure, "s", words.exposureHint)}
        <div class="pair">
          ${this.#typed("bottomLayers", words.bottomLayers, "")} ${this.#typed("bottomExposure", words.bottomExposure, "s")}
        </div>
      </div>
    </details>`;
  }

  #tolerance(): TemplateResult {
    const { settings, taken } = this;
    const { texts, format } = this.language;
    const { metric, tolerances } = settings;
    const { unit, error } = METRICS[metric];
    const least = DEFAULTS.tolerance[metric];
    const hint = taken !== null && taken > least ? texts.settings.toleranceTaken(error(least, format)) : "";
    const usual = usualTolerance(metric, taken);
    const change = (text: string): Partial<Settings> => withTolerance(settings, text);
    return this.#field("tolerance", texts.settings.tolerance, tolerances[metric] ?? usual, unit, hint, change, usual);
  }

  #length(field: Exclude<Field, "tolerance">, label: string, hint = "", placeholder = ""): TemplateResult {
    return this.#typed(field, label, "mm", hint, placeholder);
  }

  #typed(field: Exclude<Field, "tolerance">, label: string, unit: string, hint = "", placeholder = ""): TemplateResult {
    return this.#field(field, label, this.settings[field], unit, hint, (text) => ({ [field]: text }), placeholder);
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
    const isFixed = this.fixed.has(field === "tolerance" ? "tolerances" : field);
    const words = fault === undefined ? this.#hint(hint, isFixed) : faultWords(fault, this.language);
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
          aria-describedby=${words === "" ? nothing : `${field}-hint`}
          ?disabled=${isFixed}
          .value=${live(value)}
          @input=${(event: Event) => this.#say(change((event.target as HTMLInputElement).value))}
        />${unit === "" ? nothing : html`<span class="unit">${unit}</span>`}
      </div>
      ${words === "" ? nothing : html`<p class=${fault === undefined ? "hint" : "fault"} id="${field}-hint">${words}</p>`}
      ${this.#beside(field)}
    </div>`;
  }

  #select<Key extends Choice>(
    key: Key,
    label: string,
    choices: readonly (readonly [Settings[Key], string])[],
    hint = "",
    chosen: Settings[Key] = this.settings[key],
  ): TemplateResult {
    const isFixed = this.fixed.has(key);
    const words = this.#hint(hint, isFixed);
    return html`<div class="field">
      <label for=${key}>${label}</label>
      <div class="box">
        <select
          id=${key}
          aria-describedby=${words === "" ? nothing : `${key}-hint`}
          ?disabled=${isFixed}
          .value=${live(chosen)}
          @change=${(event: Event) => this.#say({ [key]: (event.target as HTMLSelectElement).value })}
        >
          ${choices.map(([value, name]) => html`<option value=${value} ?selected=${value === chosen}>${name}</option>`)}
        </select>
      </div>
      ${words === "" ? nothing : html`<p class="hint" id="${key}-hint">${words}</p>`} ${this.#beside(key)}
    </div>`;
  }

  /** The hint below a field; if that is fixed, it starts with why. */
  #hint(hint: string, isFixed: boolean): string {
    return isFixed ? `${this.language.texts.settings.fixed} ${hint}`.trim() : hint;
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
              class="visually-hidden"
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

  /** The problem that this field caused, with its offers. */
  #beside(field: Problem["field"]): TemplateResult | typeof nothing {
    const { problem, language } = this;
    if (problem === null || problem.field !== field) return nothing;
    const close = (): void => void this.dispatchEvent(new CustomEvent("cusp-dismiss"));
    return problemBox(problem, language, (change) => this.#say(change), close);
  }

  #say(patch: Partial<Settings>): void {
    this.dispatchEvent(new CustomEvent<Partial<Settings>>("cusp-settings", { detail: patch }));
  }
}
