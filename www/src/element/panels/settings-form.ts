/**
 * The settings form. It is stateless: it shows the settings that it is given, with the decimal mark of the language, and reports input in
 * canonical form. The text of a field stays as typed until the field loses focus.
 */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { FACTS, FORMATS, isFilament, usualOf } from "../../api/facts.js";
import type { CureFit, Format, MeshInfo, ModelUnit, Printer, Resin } from "../../api/wire.js";
import { languageOf } from "../../texts/index.js";
import { METRIC_NAMES, METRICS } from "../state/metric.js";
import type { Choice, Problem } from "../state/problem.js";
import { problemBox, problemStyles } from "../parts/problem-box.js";
import { adopt, FetchedPanel } from "../parts/part.js";
import type { TowersState } from "../parts/towers-offer.js";
import { found, printerSearch, printerSearchStyles, type Entry, type Search } from "../parts/printer-search.js";
import { formatFor, modelOf, printerOf } from "../state/printer.js";
import { DEFAULT_SETTINGS, faultWords, nozzleOf, RAYS, unitOf, usualTolerance, withFormat, withNozzle, withPrinter, withTolerance } from "../state/settings.js";
import type { Faults, Field, Offered, Settings } from "../state/settings.js";
import { SIZE_FIELDS } from "../state/support-sizes.js";
import { canonical, localised, read } from "../state/typed.js";
import type { Form, Typing } from "./rare-settings.js";
import { settingsStyles } from "../styles/settings-styles.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Settings that are initially hidden, unless one differs from its default. */
const MORE = ["wall", "minimize", "snap", "step", "bottomExposure", "bottomLayers", "penetration", "overcure", "retained"] as const;
const SIZES = [...SIZE_FIELDS, "raft", "supportLayer"] as const;

/** The fields of a form: all, or those of one step of the workbench. */
export type Fields = "all" | "printer" | "hollow" | "supports" | "slice";

const STRENGTHS = ["none", "light", "medium", "heavy"] as const;

/** Returns true if the form contains the field of a problem, which can then be shown next to it. */
export function hasPlace({ field }: Problem, { printer }: Settings, { printers }: Offered): boolean {
  if (field === null) return false;
  if (field === "printer") return printers.length > 0;
  return field !== "rays" || printer === "";
}

/** Units of files; the first applies to files that state none. */
const UNITS = ["millimeter", "inch", "centimeter", "meter", "foot", "micron"] as const satisfies readonly ModelUnit[];

/** Values of the list of printers that are not names: the custom printer, and its opening. */
const OWN = "{}";
const OPEN = "{…}";

/** Optional parts of a list. */
interface Choosing {
  hint?: string;
  /** The selected option, if not the setting itself. */
  value?: string;
  /** Handles a choice that does not set the setting directly. */
  change?: (value: string) => void;
}

const options = (choices: readonly (readonly [value: string, name: string])[], chosen: string): TemplateResult[] =>
  choices.map(([value, name]) => html`<option value=${value} ?selected=${value === chosen}>${name}</option>`);

const PROPERTIES = {
  fields: given<Fields>("all"),
  settings: given(DEFAULT_SETTINGS),
  faults: given<Faults>({}),
  info: given<MeshInfo | null>(null),
  /** The tolerance that the core chose by default; null if unknown. */
  taken: given<number | null>(null),
  offered: given<Offered>({ printers: [], resins: [] }),
  /** Settings that are shown read-only. */
  fixed: given<ReadonlySet<keyof Settings>>(new Set()),
  /** Failure caused by one of these settings, shown next to it. */
  problem: given<Problem | null>(null),
  towers: given<TowersState>("waiting"),
  /** Thicknesses of the test bridges as typed, and the print-through that fits them. */
  bridges: given<readonly string[]>([]),
  cureFit: given<CureFit | null>(null),
  language: given(languageOf()),
  /** Groups that were opened. */
  opened: own<ReadonlySet<Group>>(new Set()),
  /** True while a new printer is described. */
  isOpening: own(false),
  /** Search for a printer; null while the list is closed. */
  search: own<Search | null>(null),
};

type Rare = typeof import("./rare-settings.js");
type Group = "more" | "sizes";

const rareCode = new FetchedPanel<Rare>("settings", () => import("./rare-settings.js"));
const printerCode = new FetchedPanel("printer", () => import("./printer-form.js"), ({ definePrinterForm }) => definePrinterForm());

export class CuspSettings extends elementWith(PROPERTIES) {
  /** Groups of hidden settings that start expanded; null before the first update. */
  #openAtFirst: Readonly<Record<Group, boolean>> | null = null;
  /** The last custom printer. */
  #own: Printer | null = null;
  /** Text of each field as typed, with the resulting setting. */
  readonly #typed = new Map<Field, { text: string; said: string }>();

  static override styles = [shared, problemStyles, settingsStyles, printerSearchStyles];

  override willUpdate(changed: PropertyValues<this>): void {
    if (typeof this.settings.printer === "object") this.#own = this.settings.printer;
    for (const [field, { said }] of this.#typed) {
      // Changed elsewhere: by undo, an offer or a slider.
      if (changed.has("settings") && this.#setting(field) !== said) this.#typed.delete(field);
    }
    // Settings from the URL must be visible, as must those of a step. Afterwards the user expands and collapses them.
    if (this.#openAtFirst !== null && !changed.has("fields")) return;
    const isSet = (key: keyof Settings): boolean => this.settings[key] !== DEFAULT_SETTINGS[key];
    this.#openAtFirst = { more: MORE.some((key) => (key !== "wall" || this.fields === "all") && isSet(key)), sizes: SIZES.some(isSet) };
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("search")) this.renderRoot.querySelector("[role=option].active")?.scrollIntoView({ block: "nearest" });
  }

  override render(): TemplateResult {
    const { fields } = this;
    return html`<form novalidate @submit=${(event: Event) => event.preventDefault()}>
      ${fields === "hollow" ? this.#hollow() : fields === "supports" ? this.#supports() : fields === "printer" ? this.#printer() : this.#slice()}
    </form>`;
  }

  #slice(): TemplateResult {
    const { settings, info, offered } = this;
    const { texts, format } = this.language;
    const words = texts.settings;
    const isUniform = settings.planner === "uniform";
    const own = info === null ? "" : info.size_mm[2].toFixed(1);
    return html`
      ${this.#printer()} ${offered.resins.length === 0 ? nothing : this.#resin()}
      ${this.#radios("planner", words.layers, [["optimal", words.adaptive], ["uniform", words.uniform]], this.#plannerHint())}
      ${isUniform ? this.#field("uniform", words.thickness) : nothing}
      ${this.#tolerance()} ${isFilament(settings.format) ? nothing : this.#exposure()}
      <div class="pair">${this.#field("layerMin", words.thinnest)} ${this.#field("layerMax", words.thickest)}</div>
      ${isUniform ? html`<p class="hint">${words.rangeHint}</p>` : nothing}
      ${this.#field("height", words.height, { placeholder: own })} ${this.#unit()}
      ${isFilament(settings.format) || this.fields !== "all" ? nothing : this.#supports()}
      ${this.#select(
        "metric",
        words.metric,
        options(METRIC_NAMES.map((metric) => [metric, texts.metrics[metric].name]), settings.metric),
      )}
      ${this.#format()}
      ${isFilament(settings.format)
        ? this.#field("nozzle", words.nozzle, { hint: words.nozzleHint, placeholder: String(FACTS.nozzle_mm) })
        : nothing}
      ${settings.printer === ""
        ? this.#select(
            "rays",
            words.resolution,
            options(RAYS.map((rays) => [String(rays), words.pixels({ count: format.count(rays) })]), settings.rays),
            { hint: words.resolutionHint },
          )
        : nothing}
      ${this.#group("more", words.more, ({ rareFields }, form) => rareFields(form))}
    `;
  }

  #plannerHint(): string {
    const { planner, minimize } = this.settings;
    const words = this.language.texts.settings;
    if (planner === "uniform") return words.uniformHint;
    return minimize === "time" ? words.quickestHint : words.fewestHint;
  }

  /** Searchable list of printers. A custom one stays in the list while another is chosen. */
  #printer(): TemplateResult | typeof nothing {
    const { settings, offered: { printers, recent = [] }, language, isOpening, search } = this;
    if (printers.length === 0) return nothing;
    const words = language.texts.settings;
    const value = isOpening ? OPEN : typeof settings.printer === "string" ? settings.printer : OWN;
    const chosen = isOpening ? null : printerOf(settings.printer, printers);
    const other = (value: string, name: string): Entry => ({ value, name, layers: null });
    const entries = (text: string): readonly Entry[] => [
      ...(this.#own === null ? [] : [other(OWN, modelOf(this.#own))]),
      ...found(printers, text, recent),
      ...(value === "" || text !== "" ? [] : [other("", words.noPrinter)]),
      other(OPEN, words.ownPrinter),
    ];
    const isFixed = this.fixed.has("printer");
    const hint = this.#hint(isOpening ? words.ownPrinterHint : this.#printerHint(), isFixed);
    return html`<div class="field">
      <label for="printer">${this.fields === "printer" ? words.yourPrinter : words.printer}</label>
      ${printerSearch({
        ...{ search, value, isFixed, language },
        chosen: isOpening ? words.ownPrinter : chosen === null ? value : modelOf(chosen),
        describedBy: hint === "" ? null : "printer-hint",
        entries: search === null ? [] : entries(search.text),
        searches: (search) => (this.search = search),
        choose: (value) => this.#choosePrinter(value),
      })}
      ${hint === "" ? nothing : html`<p class="hint" id="printer-hint">${hint}</p>`} ${value === OPEN || value === OWN ? this.#ownPrinter(isFixed) : nothing} ${this.#beside("printer")}
    </div>`;
  }

  #choosePrinter(value: string): void {
    this.search = null;
    this.isOpening = value === OPEN;
    if (!this.isOpening) this.#say(withPrinter(this.settings, value === OWN ? (this.#own ?? "") : value));
  }

  #printerHint(): string {
    const { settings, offered, language: { texts, format } } = this;
    if (settings.printer === "") return texts.settings.noPrinterHint;
    const printer = printerOf(settings.printer, offered.printers);
    if (printer === null) return "";
    const { pixels, pitch_um, volume_mm } = printer;
    return texts.settings.printerHint({ model: modelOf(printer), pixels: pixels.map(format.count).join(" × "), pitch: `${[...new Set(pitch_um)].map(format.tick).join(" × ")}\u00a0µm`, volume: format.dimensions(volume_mm) }
    );
  }

  /** Form of a printer that is not in the list. */
  #ownPrinter(isFixed: boolean): TemplateResult | typeof nothing {
    if (isFixed) return nothing;
    const { language, settings: { printer } } = this;
    if (!printerCode.isThere) return printerCode.instead(this, language);
    return html`<cusp-printer-form
      .printer=${this.isOpening || typeof printer === "string" ? null : printer}
      .language=${language}
      @cusp-printer=${({ detail }: CustomEvent<Printer>) => {
        this.isOpening = false;
        this.#say(withPrinter(this.settings, { name: modelOf(detail), ...detail }));
      }}
      @cusp-open-printer=${({ detail }: CustomEvent<File>) => {
        this.isOpening = false;
        this.dispatchEvent(new CustomEvent<File>("cusp-open-printer", { detail }));
      }}
    ></cusp-printer-form>`;
  }

  #resin(): TemplateResult {
    const { settings: { resin: chosen }, offered: { resins } } = this;
    const words = this.language.texts.settings;
    const list = options([["", words.resinUsual], ...resins.map(({ name = "" }) => [name, name] as const)], chosen);
    return this.#select("resin", words.resin, list);
  }

  /** Values of the resin, used unless others are typed. */
  get #cure(): Required<Omit<Resin, "print_through">> & Pick<Resin, "print_through"> {
    return { ...FACTS.defaults.resin, ...this.offered.resins.find(({ name }) => name === this.settings.resin) };
  }

  #exposure(): TemplateResult {
    const { texts: { settings: words }, format } = this.language;
    const { exposure_s, layer_mm } = this.#cure;
    return this.#field("exposure", words.exposure, { hint: words.exposureHint({ thickness: format.fine(layer_mm) }), placeholder: String(exposure_s) });
  }

  #format(): TemplateResult {
    const { settings: { printer, format }, offered } = this;
    const words = this.language.texts.settings;
    const value = format === "" && printer === "" ? "png" : format;
    const usual = formatFor({ printer, format: "" }, offered.printers);
    const list = html`${printer === "" ? nothing : options([["", words.formatUsual]], value)}
      ${options(FORMATS.map((format) => [format, words.formats[format]]), value)}`;
    const change = (value: string): void => this.#say(withFormat(this.settings, value as Format | ""));
    return this.#select("format", words.format, list, { value, change, hint: value === "" ? words.formats[usual] : "" });
  }

  /** Unit of a file that states none. */
  #unit(): TemplateResult | typeof nothing {
    const { settings: { unit }, info } = this;
    if (info === null || (info.unit ?? null) !== null) return nothing;
    const words = this.language.texts.settings;
    const list = options(UNITS.map((unit) => [unit, words.units[unit]]), unit || UNITS[0]);
    const change = (value: string): void => this.#say({ unit: value === UNITS[0] ? "" : (value as ModelUnit) });
    return this.#select("unit", words.unit, list, { value: unit || UNITS[0], change });
  }

  /** A collapsible group of rarely used fields, which are fetched when it opens. */
  #group(name: Group, summary: string, fields: (code: Rare, form: Form) => TemplateResult): TemplateResult {
    const isOpen = this.opened.has(name) || this.#openAtFirst?.[name] === true;
    const toggled = ({ target }: Event): void => {
      if ((target as HTMLDetailsElement).open && !this.opened.has(name)) this.opened = new Set([...this.opened, name]);
    };
    return html`<details ?open=${this.#openAtFirst?.[name]} @toggle=${toggled}>
      <summary>${summary}</summary>
      ${isOpen ? html`<div class="more">${this.#fetched(fields)}</div>` : nothing}
    </details>`;
  }

  #fetched(fields: (code: Rare, form: Form) => TemplateResult): TemplateResult | typeof nothing {
    const { code } = rareCode;
    if (code === null) return rareCode.instead(this, this.language);
    adopt(this, code.rareStyles);
    const { settings, language, towers, bridges, cureFit } = this;
    return fields(code, {
      settings,
      language,
      towers,
      bridges,
      cureFit,
      isWhole: this.fields === "all",
      isFixedPrinter: this.fixed.has("printer"),
      cure: this.#cure,
      field: (...of) => this.#field(...of),
      radios: (...of) => this.#radios(...of),
      hollow: () => this.#hollow(),
      say: (name, detail) => void this.dispatchEvent(new CustomEvent(name, { detail })),
    });
  }

  #supports(): TemplateResult {
    const { texts: { settings: words } } = this.language;
    const { supports } = this.settings;
    const list = STRENGTHS.map((strength) => [strength, words.strengths[strength]] as const);
    return html`${this.#select("supports", words.supports, options(list, supports), { hint: words.supportsHint })}
      ${supports === "none" ? nothing : this.#group("sizes", words.supportSizes, ({ sizeFields }, form) => sizeFields(form, supports))}`;
  }

  /** Hollowing. Infill and drain holes appear once a wall thickness is set. */
  #hollow(): TemplateResult {
    const { wall, infill, drain } = this.settings;
    const words = this.language.texts.settings;
    const field = this.#field("wall", words.wall, { hint: words.wallHint });
    if (wall.trim() === "") return field;
    return html`${field}
      ${this.#select("infill", words.infill, options([["none", words.noInfill], ["lattice", words.lattice]], infill))}
      ${this.#select("drain", words.drain, options([["auto", words.autoDrain], ["none", words.noDrain]], drain))}`;
  }

  /** The tolerance, with its meaning, or the reason for which the core chose another than usual. */
  #tolerance(): TemplateResult {
    const { settings: { metric, format: file, nozzle }, taken } = this;
    const { texts, format } = this.language;
    const least = usualOf(metric, file, nozzleOf(nozzle));
    const isMore = taken !== null && taken > least;
    const hint = isMore ? texts.settings.toleranceTaken({ usual: METRICS[metric].error(least, format) }) : texts.metrics[metric].help;
    return this.#field("tolerance", texts.settings.tolerance, { hint, placeholder: usualTolerance(metric, taken, file, nozzle) });
  }

  /** Setting of a field; undefined for a tolerance not typed. */
  #setting(field: Field): string | undefined {
    const { settings } = this;
    return field === "tolerance" ? settings.tolerances[settings.metric] : settings[field];
  }

  #field(field: Field, label: string, { hint = "", placeholder = "" }: Typing = {}): TemplateResult {
    const { settings, language: { format } } = this;
    const unit = unitOf(field, settings.metric);
    // A default tolerance is also shown, so that the user can judge it.
    const value = this.#typed.get(field)?.text ?? localised(this.#setting(field) ?? placeholder, format.decimal);
    const fault = this.faults[field];
    const isFixed = this.fixed.has(field === "tolerance" ? "tolerances" : field);
    const words = fault === undefined ? this.#hint(hint, isFixed) : faultWords(fault, this.language);
    const typed = ({ target }: Event): void => {
      const { value: text } = target as HTMLInputElement;
      const said = canonical(text, unit, format.decimal);
      this.#typed.set(field, { text, said });
      if (said === this.#setting(field)) return;
      if (field === "tolerance") this.#say(withTolerance(settings, said));
      else this.#say(field === "nozzle" ? withNozzle(settings, said) : { [field]: said });
    };
    const left = ({ target }: Event): void => {
      const { value: text } = target as HTMLInputElement;
      // Unreadable input stays for correction.
      if (text.trim() !== "" && read(text, unit, format.decimal).value === null) return;
      this.#typed.delete(field);
      this.requestUpdate();
    };
    return html`<div class="field">
      <label for=${field}>${label}</label>
      <div class="box ${fault === undefined ? "" : "wrong"}">
        <input
          type="text"
          inputmode="decimal"
          autocomplete="off"
          id=${field}
          placeholder=${localised(placeholder, format.decimal)}
          aria-invalid=${fault === undefined ? "false" : "true"}
          aria-describedby=${words === "" ? nothing : `${field}-hint`}
          ?disabled=${isFixed}
          .value=${live(value)}
          @input=${typed}
          @blur=${left}
        />${unit === "" ? nothing : html`<span class="unit">${unit}</span>`}
      </div>
      ${words === "" ? nothing : html`<p class=${fault === undefined ? "hint" : "fault"} id="${field}-hint">${words}</p>`}
      ${this.#beside(field)}
    </div>`;
  }

  #select(key: Choice, label: string, list: unknown, { hint = "", value, change }: Choosing = {}): TemplateResult {
    const isFixed = this.fixed.has(key);
    const say = change ?? ((value: string): void => this.#say({ [key]: value }));
    const words = this.#hint(hint, isFixed);
    return html`<div class="field">
      <label for=${key}>${label}</label>
      <div class="box list">
        <select
          id=${key}
          aria-describedby=${words === "" ? nothing : `${key}-hint`}
          ?disabled=${isFixed}
          .value=${live(value ?? this.settings[key])}
          @change=${(event: Event) => say((event.target as HTMLSelectElement).value)}
        >
          ${list}
        </select>
      </div>
      ${words === "" ? nothing : html`<p class="hint" id="${key}-hint">${words}</p>`} ${this.#beside(key)}
    </div>`;
  }

  /** Hint below a field; if fixed, preceded by the reason. */
  #hint(hint: string, isFixed: boolean): string {
    return isFixed ? `${this.language.texts.settings.fixed} ${hint}`.trim() : hint;
  }

  #radios(key: "planner" | "minimize" | "snap" | "raft", legend: string, choices: readonly (readonly [string, string])[], hint: string): TemplateResult {
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

  /** The problem caused by this field, with its offers. */
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
