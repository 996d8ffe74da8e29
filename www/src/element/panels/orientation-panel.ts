/** The orientation panel: the aims of the search, the sphere of energies, and the best orientations to choose from. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { Found, Slicer } from "../../api/index.js";
import type { Candidate, Metric } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import { gradient, type PaletteName } from "../../view/legend/palette.js";
import type { Rotation } from "../../view/scene/pose.js";
import { orientationStyles } from "../styles/orientation-styles.js";
import { energyRange, type Looked } from "./orientation-sphere.js";
import type { Aims, OrientationSearch } from "../state/orientation.js";
import { METRICS } from "../state/metric.js";
import { partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import { progressBar, progressStyles, type Busy } from "../parts/progress.js";
import { rotationText } from "../state/settings.js";
import { styled } from "../parts/styled.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

const COSTS: readonly Aims["cost"][] = ["layers", "time"];
const QUALITIES: readonly Aims["quality"][] = ["error", "roughness", "overhang"];
const MICROMETRES = 1000;
/** Number of steps of the slider. */
const STEPS = 20;
/** Side length of a thumbnail in pixels; it is shown at half that size. */
const PICTURE_PX = 256;

/** The part of a search that the panel shows. */
export type Searched = Readonly<Pick<OrientationSearch, "aims" | "found" | "best" | "busy" | "isCurrent" | "isPossible" | "options">>;

const PROPERTIES = {
  slicer: given<Slicer | null>(null),
  searched: given<Searched | null>(null),
  /** The metric of errors if the search's options name none. */
  metric: given<Metric>("cusp"),
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** The rotation of the camera in the view beside it; null without a view. */
  camera: given<Rotation | null>(null),
  palette: given<PaletteName>("classic"),
  language: given(languageOf()),
  /** The candidate that is pointed at, or chosen on the sphere. */
  looked: own<Looked | null>(null),
  /** Whether the code that draws the thumbnails could not be fetched. */
  isUnpictured: own(false),
};

export class CuspOrientation extends elementWith(PROPERTIES) {
  #drawing: AbortController | null = null;

  static override styles = [shared, progressStyles, partStyles, orientationStyles];

  override firstUpdated(): void {
    // Thumbnails have the page's colours. Any change of those starts a transition on the probe.
    this.renderRoot.addEventListener("transitionrun", ({ target }) => {
      if ((target as Element).classList.contains("probe")) void this.#drawThumbnails();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#drawing?.abort();
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("searched") && changed.get("searched")?.best !== this.searched?.best) void this.#drawThumbnails();
  }

  override render(): TemplateResult {
    const { searched, language } = this;
    const { orientation: words } = language.texts;
    if (searched === null) return html`${nothing}`;
    const { found, busy, isCurrent, isPossible } = searched;
    return html`
      <span class="probe"></span>
      <div class="head">
        <h3>${words.title}</h3>
        ${busy === null
          ? html`<button class="small find" ?disabled=${!isPossible} @click=${() => this.#say("cusp-search", null)}>
              ${found === null || isCurrent ? words.find : words.again}
            </button>`
          : nothing}
      </div>
      ${found === null && busy === null ? html`<p class="quiet hint">${words.hint}</p>` : nothing}
      ${found !== null && busy === null && !isCurrent ? html`<p class="stale">${words.stale}</p>` : nothing}
      ${this.#aims(searched.aims)} ${busy === null ? nothing : this.#progress(busy, searched)}
      ${found === null ? nothing : this.#results(searched, found)}
      <p class="visually-hidden" role="status">${this.#announcement(searched)}</p>
    `;
  }

  #aims({ alpha, cost, quality }: Aims): TemplateResult {
    const { texts, format } = this.language;
    const { orientation: words } = texts;
    const choice = <T extends string>(
      name: string,
      value: T,
      values: readonly T[],
      names: Readonly<Record<T, string>>,
      set: (value: T) => void,
    ): TemplateResult => html`<label class="field">
      <span>${name}</span>
      <select @change=${({ target }: Event) => set((target as HTMLSelectElement).value as T)}>
        ${values.map((it) => html`<option value=${it} ?selected=${it === value}>${names[it]}</option>`)}
      </select>
    </label>`;
    const said = words.parts(words.costs[cost], format.percent(alpha), words.qualities[quality], format.percent(1 - alpha));
    return html`<div class="aims">
      ${choice(words.cost, cost, COSTS, words.costs, (cost) => this.#aim({ cost }))}
      ${choice(words.quality, quality, QUALITIES, words.qualities, (quality) => this.#aim({ quality }))}
      <div class="balance">
        <label for="balance">${words.balance}</label>
        <input
          id="balance"
          type="range"
          min="0"
          max=${STEPS}
          .value=${live(String(Math.round((1 - alpha) * STEPS)))}
          aria-valuetext=${said}
          @input=${({ target }: Event) => this.#aim({ alpha: 1 - Number((target as HTMLInputElement).value) / STEPS })}
        />
        <div class="ends quiet"><span>${words.fewer[cost]}</span><span>${words.better[quality]}</span></div>
      </div>
    </div>`;
  }

  /** The progress bar; it appears late while candidates are only rated again, which is usually done before. */
  #progress(busy: Busy, { best }: Searched): TemplateResult {
    return html`<div class=${best.length > 0 ? "again quick" : "again"}>
      ${progressBar(busy, this.language, () => this.#say("cusp-search-cancel", null))}
    </div>`;
  }

  #results(searched: Searched, found: Found): TemplateResult {
    const { best, busy, isCurrent } = searched;
    const { texts } = this.language;
    const fits = found.candidates.some((candidate) => candidate?.excluded === null);
    return html`<div class="results ${busy === null && !isCurrent ? "old" : ""}">
      <div class="globe">
        <cusp-sphere
          .found=${found}
          .best=${best}
          .rotation=${this.rotation}
          .camera=${this.camera}
          .palette=${this.palette}
          .language=${this.language}
          @cusp-look=${(event: CustomEvent<Looked | null>) => (this.looked = event.detail)}
          @cusp-orient=${(event: CustomEvent<Candidate>) => this.#orient(event.detail)}
        ></cusp-sphere>
        ${this.#legend(found)} ${this.#metrics(searched)}
      </div>
      <div class="best">
        ${best.length > 0 ? html`<h4>${texts.orientation.best}</h4>` : nothing}
        ${this.isUnpictured && best.length > 0 ? partFailure(this.language, () => void this.#drawThumbnails()) : nothing}
        ${best.map((candidate, i) => this.#choice(candidate, i, searched))}
        ${!fits && busy === null ? html`<p class="quiet">${texts.orientation.none}</p>` : nothing}
      </div>
    </div>`;
  }

  #legend({ candidates }: Found): TemplateResult {
    const { texts, format } = this.language;
    const { orientation: words } = texts;
    const range = energyRange(candidates);
    const hasExcluded = candidates.some((candidate) => candidate !== null && candidate.excluded !== null);
    return html`<div class="legend">
      ${range === null
        ? nothing
        : html`<span class="quiet">${words.legend}</span>
            <div class="scale">
              <span>${format.tick(range[0])}</span>
              <i ${styled({ background: gradient(this.palette, "to left") })}></i>
              <span>${format.tick(range[1])}</span>
            </div>`}
      <div class="keys quiet">
        <span><svg viewBox="-9 -9 18 18" aria-hidden="true"><path d="M-8 0h16M0 -8v16" /></svg>${words.upright}</span>
        ${hasExcluded ? html`<span><i class="excluded"></i>${words.excluded}</span>` : nothing}
      </div>
    </div>`;
  }

  /** The metrics of the candidate that is pointed at, or chosen on the sphere. */
  #metrics({ options }: Searched): TemplateResult {
    const { looked, language } = this;
    const { orientation: words } = language.texts;
    if (looked === null) return html`<p class="looked quiet hint">${words.point}</p>`;
    const { candidate, isChosen } = looked;
    const rows = metricRows(candidate, options?.metric ?? this.metric, language);
    return html`<div class="looked figures" data-direction=${candidate.direction.join()}>
      ${candidate.excluded === null ? nothing : html`<p class="why">${words.why[candidate.excluded]}</p>`}
      <dl>${rows.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`)}</dl>
      ${isChosen && candidate.excluded === null
        ? html`<button class="small" @click=${() => this.#orient(candidate)}>${words.apply}</button>`
        : nothing}
    </div>`;
  }

  #choice(candidate: Candidate, place: number, { options }: Searched): TemplateResult {
    const { language } = this;
    const { texts, format } = language;
    const { metrics } = candidate;
    const isApplied = rotationText(candidate.rotation) === rotationText(this.rotation);
    const { error } = METRICS[options?.metric ?? this.metric];
    return html`<button
      class="pose"
      aria-pressed=${isApplied ? "true" : "false"}
      @click=${() => this.#orient(candidate)}
    >
      <canvas width=${PICTURE_PX} height=${PICTURE_PX} aria-hidden="true"></canvas>
      <span class="rank" aria-hidden="true">${place + 1}</span>
      <span class="visually-hidden">${texts.orientation.rank(format.count(place + 1))}:</span>
      ${metrics === null
        ? nothing
        : html`<span class="what">
            <strong>${format.count(metrics.layers)} ${texts.plan.layers(metrics.layers)}</strong>
            <span>${format.time(metrics.print_time_s)}</span>
            <span class="quiet">${texts.orientation.error} ${error(metrics.max_error, format)}</span>
            <span class="quiet">${texts.orientation.roughness} ${micrometres(metrics.roughness_mm, language)}</span>
            <span class="quiet">${texts.orientation.overhang} ${format.area(metrics.overhang_mm2)}</span>
          </span>`}
    </button>`;
  }

  #announcement({ busy, found, best, options }: Searched): string {
    const { looked, language } = this;
    const { texts, format } = language;
    if (looked !== null) {
      const { excluded, metrics } = looked.candidate;
      if (excluded !== null) return texts.orientation.why[excluded];
      if (metrics === null) return "";
      const error = METRICS[options?.metric ?? this.metric].error(metrics.max_error, format);
      return texts.orientation.said(metrics.layers, format.time(metrics.print_time_s), error);
    }
    if (busy !== null) return texts.progress[busy.stage];
    return found !== null && best.length > 0 ? texts.orientation.found(format.count(found.candidates.length)) : "";
  }

  /** Draws the best poses. The model's positions are fetched for this and not kept. */
  async #drawThumbnails(): Promise<void> {
    this.#drawing?.abort();
    const { slicer, searched } = this;
    if (slicer === null || searched === null || searched.best.length === 0) return;
    const drawing = new AbortController();
    this.#drawing = drawing;
    const { signal } = drawing;
    // Without thumbnails there are still the metrics; a broken worker is reported elsewhere.
    const positions = await slicer.positions().catch(() => null);
    if (positions === null || signal.aborted) return;
    const pictures = await import("../../view/scene/thumbnails.js").catch((error: unknown) => {
      tellPartFailed(this, "pictures", error);
      return null;
    });
    this.isUnpictured = pictures === null;
    if (pictures === null || signal.aborted) return;
    const canvases = [...this.renderRoot.querySelectorAll<HTMLCanvasElement>(".pose canvas")];
    const thumbnails = searched.best.flatMap(({ rotation }, i) => {
      const canvas = canvases[i];
      return canvas === undefined ? [] : [[canvas, rotation] as const];
    });
    await pictures.drawThumbnails(positions, thumbnails, this, signal);
    for (const [canvas] of thumbnails) canvas.dataset["drawn"] = "";
  }

  #aim(change: Partial<Aims>): void {
    this.#say<Partial<Aims>>("cusp-aims", change);
  }

  #orient(candidate: Candidate): void {
    this.#say<Candidate>("cusp-orient", candidate);
  }

  #say<Detail>(type: string, detail: Detail): void {
    this.dispatchEvent(new CustomEvent<Detail>(type, { detail }));
  }
}

function micrometres(mm: number, { format }: Language): string {
  return `${format.tick(Math.round(mm * MICROMETRES * 10) / 10)}\u00a0µm`;
}

/** The metrics, energy and size of a candidate that are known, as pairs of name and value. */
export function metricRows({ metrics, size_mm, energy }: Candidate, metric: Metric, language: Language): [string, string][] {
  const { texts, format } = language;
  const { orientation: words } = texts;
  const rows: [string, string][] = [];
  if (metrics !== null) {
    rows.push(
      [words.layers, format.count(metrics.layers)],
      [words.time, format.time(metrics.print_time_s)],
      [words.error, METRICS[metric].error(metrics.max_error, format)],
      [words.roughness, micrometres(metrics.roughness_mm, language)],
      [words.overhang, format.area(metrics.overhang_mm2)],
    );
  }
  if (energy !== null) rows.push([words.energy, format.tick(energy)]);
  rows.push([words.size, format.dimensions(size_mm)]);
  return rows;
}
