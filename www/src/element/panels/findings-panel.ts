/** `<cusp-findings>`: the faults expected when the plan is printed, by kind. Choosing a finding shows its place. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import type { SlicerError } from "../../api/index.js";
import type { Count, Finding, Metric, Printability, Severity } from "../../api/wire.js";
import { findingsTexts, saidOf, type FindingsTexts } from "../../texts/findings.js";
import { languageOf, type Language } from "../../texts/index.js";
import { errorOf } from "../../texts/problems.js";
import { elementWith, given, own } from "../../view/properties.js";
import { define } from "../define.js";
import type { Checked } from "../state/checked.js";
import type { Checks } from "../state/checks.js";
import { canSupport, fixOf, type Fix } from "../state/fixes.js";
import { added, pointAt, pointsOf } from "../state/hand-points.js";
import type { Session } from "../state/session.js";
import { DEFAULT_SETTINGS, type Settings } from "../state/settings.js";
import { viewTexts } from "../parts/view-texts.js";
import { findingsStyles } from "../styles/findings-styles.js";
import { shared } from "../styles/shared.js";
import { shown } from "../../api/visible.js";

/** Number of findings per kind that are shown initially; none of those that are notes. */
const FEW = 3;

/** Distance of a new support point below a finding, whose underside is nearer then than its sides. */
const BELOW_MM = 0.2;

/** A tick; an exclamation mark; a cross. */
const SIGNS = {
  ok: "m4.5 10.5 4 4 7-8.5",
  note: "M10 9v6m0-9.5v.01",
  review: "M10 5v6.5m0 3.2v.01",
  reject: "m5.5 5.5 9 9m0-9-9 9",
} as const;

/** Severities of findings; what is ignored is not looked for. */
const SEVERITIES = ["note", "review", "reject"] as const satisfies readonly Severity[];

type Shown = (typeof SEVERITIES)[number];

const PROPERTIES = {
  checks: given<Checks | null>(null),
  /** The session whose supports a finding may get. */
  session: given<Pick<Session, "settings" | "options" | "result" | "isCurrent" | "plate" | "change"> | null>(null),
  /** Verdict of the last check; of an earlier plan unless `isCurrent`. */
  verdict: given<Printability["verdict"] | null>(null),
  /** Findings of that check per model; `names` has the models' names. */
  models: given<readonly Checked[]>([]),
  names: given<readonly string[]>([], (a: unknown, b: unknown) => String(a) !== String(b)),
  isCurrent: given(false),
  /** Reason for which the plan could not be checked. */
  error: given<SlicerError | null>(null),
  chosen: given<Finding | null>(null),
  /** True if a view can show the wall thickness of the selected model. */
  hasView: given(true),
  showsWalls: given(false),
  /** Walls thinner than this are thin, mm. */
  wall_mm: given(0),
  metric: given<Metric>("cusp"),
  settings: given(DEFAULT_SETTINGS),
  /** Settings that must not change. */
  fixed: given<ReadonlySet<keyof Settings>>(new Set()),
  /** True if a search for a better direction can be started and shown. */
  canOrient: given(false),
  language: given<Language>(languageOf()),
  /** Kinds, per model, whose findings are all shown. */
  whole: own<ReadonlySet<string>>(new Set()),
};

export class CuspFindings extends elementWith(PROPERTIES) {
  static override styles = [shared, findingsStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.checks !== null) this.checks.isOpen = true;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    if (this.checks !== null) this.checks.isOpen = false;
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("checks") && this.checks !== null && this.isConnected) this.checks.isOpen = true;
  }

  override render(): TemplateResult {
    const { verdict, models, isCurrent, error, language } = this;
    const words = findingsTexts(language);
    return html`
      <div class="head"><h3>${language.texts.findings.title}</h3></div>
      <div role="status">${this.#verdict(words)}</div>
      ${this.hasView ? this.#walls(words) : nothing}
      ${verdict === null || error !== null
        ? nothing
        : html`<div class="kinds ${isCurrent ? "" : "old"}" @keydown=${this.#pressed}>
            ${this.#hasFindings ? html`<p class="quiet">${words.hint}</p>` : nothing}
            ${models.map((checked, place) => this.#model(checked, place, words))}
          </div>`}
    `;
  }

  #verdict(words: FindingsTexts): TemplateResult {
    const { verdict, error, isCurrent, language, metric } = this;
    if (error !== null) return html`<p class="quiet failed">${sentenceOf(error, language, metric)}</p>`;
    if (verdict === null || !isCurrent) return html`<p class="quiet">${words.checking}</p>`;
    return html`<p class="verdict ${verdict}" data-verdict=${verdict}>${sign(verdict)} ${words.verdicts[verdict]}</p>
      ${!this.#hasFindings ? html`<p class="quiet">${words.none}</p>` : nothing}`;
  }

  /** Switch for the wall thickness colours on the model. */
  #walls(words: FindingsTexts): TemplateResult {
    const { showsWalls, wall_mm, language: { format } } = this;
    return html`<label class="show-walls">
        <input
          type="checkbox"
          role="switch"
          aria-describedby="walls-hint"
          .checked=${showsWalls}
          @change=${({ target }: Event) => {
            if (this.checks !== null) this.checks.showsWalls = (target as HTMLInputElement).checked;
          }}
        />
        ${words.walls}
      </label>
      <p class="quiet" id="walls-hint">${words.wallsHint({ limit: format.mm(wall_mm) })}</p>
      ${showsWalls ? html`<cusp-wall-legend .wall_mm=${wall_mm} .texts=${viewTexts(this.language)}></cusp-wall-legend>` : nothing}`;
  }

  get #hasFindings(): boolean {
    return this.models.some(({ found }) => found.findings.length > 0);
  }

  /** Findings of a model, under its name if there are several models. */
  #model(checked: Checked, place: number, words: FindingsTexts): TemplateResult | typeof nothing {
    const { model, copies_mm, found } = checked;
    if (found.findings.length === 0) return nothing;
    const name = model === null ? null : shown(this.names[model] ?? "");
    return html`${name === null ? nothing : html`<h4 class="model">${this.language.format.count(copies_mm.length)} × ${name}</h4>`}
    ${found.counts
      .map((count) => ({ count, severity: severityOf(count.code, found.findings) }))
      .toSorted((a, b) => SEVERITIES.indexOf(b.severity) - SEVERITIES.indexOf(a.severity))
      .map(({ count, severity }) => this.#kind(count, severity, checked, `${count.code}-${place}`, words))}`;
  }

  #kind({ code, found }: Count, severity: Shown, checked: Checked, id: string, words: FindingsTexts): TemplateResult {
    const { format } = this.language;
    const { findings } = checked.found;
    const listed = findings.filter((finding) => finding.code === code);
    const isNote = severity === "note";
    const few = isNote ? 0 : FEW;
    const isChosenLate = this.chosen !== null && listed.indexOf(this.chosen) >= few;
    const shown = this.whole.has(id) || isChosenLate ? listed : listed.slice(0, few);
    return html`<section aria-labelledby=${id}>
      <h4 id=${id}>
        ${sign(severity)} <span class="name">${words.kinds[code]}</span> <span class="count figures">${format.count(found)}</span>
        <span class="severity quiet">${words.severities[severity]}</span>
      </h4>
      ${isNote ? nothing : html`<p class="quiet" id="${id}-advice">${words.advice[code]}</p> ${this.#fix(code, id, words)}`}
      <ul>
        ${shown.map((finding) => this.#item(finding, checked, isNote ? nothing : `${id}-advice`, words))}
      </ul>
      ${shown.length < listed.length
        ? html`<button class="link" @click=${() => (this.whole = new Set([...this.whole, id]))}>${words.all({ count: format.count(listed.length) })}</button>`
        : found > listed.length
          ? html`<p class="quiet">${words.smaller({ count: format.count(found - listed.length) })}</p>`
          : nothing}
    </section>`;
  }

  /** Button for the remedy of a kind, if settings or another direction are one. */
  #fix(code: Count["code"], id: string, words: FindingsTexts): TemplateResult | typeof nothing {
    const fix = fixOf(code, this.settings);
    if (fix === null || (fix.change === null ? !this.canOrient : Object.keys(fix.change).some((key) => this.fixed.has(key as keyof Settings)))) return nothing;
    const ask = (): void => void this.dispatchEvent(new CustomEvent<Fix>("cusp-fix", { detail: fix, bubbles: true }));
    return html`<button class="small fix" aria-describedby=${id} ?disabled=${!this.isCurrent} @click=${ask}>${words.fixes[fix.name]}</button>`;
  }

  #item(finding: Finding, checked: Checked, advice: string | typeof nothing, words: FindingsTexts): TemplateResult {
    const { format } = this.language;
    const { at_mm, layers: [first, last], code } = finding;
    const place = `${at_mm.map((mm) => format.tick(Math.round(mm * 100) / 100)).join(" / ")}\u00a0mm`;
    const layers = first === last ? words.layer({ number: format.count(first + 1) }) : words.layers({ first: format.count(first + 1), last: format.count(last + 1) });
    return html`<li>
      <button
        class="finding"
        aria-pressed=${finding === this.chosen ? "true" : "false"}
        aria-describedby=${advice}
        ?disabled=${!this.isCurrent}
        @click=${() => this.checks?.choose(finding)}
      >
        <span>${words.sentences[code](saidOf(finding, format))}</span>
        <span class="quiet figures">${layers} · ${place}</span>
      </button>
      ${finding === this.chosen ? this.#support(finding, checked, words) : nothing}
    </li>`;
  }

  /** Button that adds a support at a finding's place on the selected model. */
  #support({ code, at_mm: [x, y, z] }: Finding, { model, from_mm, turn_deg }: Checked, words: FindingsTexts): TemplateResult | typeof nothing {
    const { session, settings } = this;
    if (session === null || !canSupport(code, settings) || turn_deg !== 0 || this.fixed.has("points")) return nothing;
    const { entries, selected } = session.plate;
    if (model !== null && model !== selected) return nothing;
    const add = (): void => {
      const { options, result, isCurrent } = session;
      const points = pointsOf("points", { settings, options, result, isCurrent, isAlone: entries.length < 2 });
      // Points are measured from the model, findings from the plate.
      const lift_mm = result?.own?.supported?.lift_mm ?? 0;
      const point = pointAt("points", { at_mm: [x - from_mm[0], y - from_mm[1], z - lift_mm - BELOW_MM], inward: [0, 0, 1] }, null);
      session.change(added(points, point, settings));
    };
    return html`<button class="small fix" ?disabled=${!this.isCurrent} @click=${add}>${words.fixes.here}</button>`;
  }

  /** Arrow keys move between findings, and Escape clears the choice. */
  readonly #pressed = (event: KeyboardEvent): void => {
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    if (step !== 0) {
      const all = [...this.renderRoot.querySelectorAll<HTMLElement>("button.finding")];
      const to = all[all.indexOf(event.target as HTMLElement) + step];
      if (to === undefined) return;
      event.preventDefault();
      to.focus();
    } else if (event.key === "Escape" && this.chosen !== null) {
      // Keeps Escape from closing the sheet around the panel.
      event.stopPropagation();
      this.checks?.choose(null);
    }
  };
}

/** The largest severity of a kind: that of its first finding, since they come from the most severe down. */
function severityOf(kind: Count["code"], findings: readonly Finding[]): Shown {
  const severity = findings.find(({ code }) => code === kind)?.severity ?? "note";
  return severity === "ignore" ? "note" : severity;
}

function sign(of: keyof typeof SIGNS): TemplateResult {
  return html`<svg class=${of} viewBox="0 0 20 20" aria-hidden="true"><path d=${SIGNS[of]} /></svg>`;
}

/** Reason for which a check failed. Code and detail belong to the same error. */
const sentenceOf = ({ code, detail }: SlicerError, language: Language, metric: Metric): string => errorOf(code, detail, metric, language);

export function defineFindings(): void {
  define("cusp-findings", CuspFindings);
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-findings": CuspFindings;
  }
}
