/** The orientation panel: the aims of the search, the sphere of scores, the current orientation, and the best ones to choose from. */
import { html, nothing, type PropertyValues, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import type { Found } from "../../api/index.js";
import type { ModelCalls } from "../state/selected.js";
import type { Candidate, Metric } from "../../api/wire.js";
import { languageOf, type Language } from "../../texts/index.js";
import { orientationTexts } from "../../texts/orientation.js";
import { gradient } from "../../view/legend/palette.js";
import type { Rotation } from "../../view/scene/pose.js";
import { define } from "../define.js";
import { orientationStyles } from "../styles/orientation-styles.js";
import { CuspSphere, energyRange, type Looked } from "./orientation-sphere.js";
import { differences, figure, type Term } from "../state/differences.js";
import { isPose, type Aims, type OrientationSearch } from "../state/orientation.js";
import { partFailure, partStyles, tellPartFailed } from "../parts/part.js";
import { fetchPictures } from "../parts/pictures.js";
import { progressBar, progressStyles, type Busy } from "../parts/progress.js";
import { rotationText } from "../state/settings.js";
import { styled } from "../parts/styled.js";
import { typed } from "../parts/typed.js";
import { shared } from "../styles/shared.js";
import { elementWith, given, own } from "../../view/properties.js";

/** Terms that a search weighs, in the order of the panel. */
const RANKED = ["islands", "supports", "contacts", "cups", "overhang", "height", "time", "layers", "roughness", "error"] as const;
/** Largest weight. */
const MOST_WEIGHT = 3;
/** Metrics with an exclusion limit, and the aims that hold it. */
const LIMITS = { overhang: "most_overhang_mm2", islands: "most_islands", cups: "most_cups_mm2" } as const;
/** Side length of a thumbnail in pixels; it is shown at half that size. */
const PICTURE_PX = 256;

/** The fields of a search that the panel shows. */
export type Searched = Readonly<Pick<OrientationSearch, "aims" | "found" | "best" | "now" | "busy" | "isCurrent" | "isPossible" | "options">>;

const PROPERTIES = {
  slicer: given<ModelCalls | null>(null),
  searched: given<Searched | null>(null),
  /** Error metric if the search's options name none. */
  metric: given<Metric>("cusp"),
  rotation: given<Rotation>([0, 0, 0, 1]),
  /** Camera rotation of the neighbouring view; null without a view. */
  camera: given<Rotation | null>(null),
  language: given(languageOf()),
  /** The candidate under the pointer, or chosen on the sphere. */
  looked: own<Looked | null>(null),
  /** The candidate whose card is under the pointer or has the focus. */
  pointed: own<Candidate | null>(null),
  /** True if the code for thumbnails could not be fetched. */
  isUnpictured: own(false),
};

export class CuspOrientation extends elementWith(PROPERTIES) {
  #drawing: AbortController | null = null;
  /** The rotation of the model drawn on each canvas. */
  #drawn = new WeakMap<HTMLCanvasElement, string>();

  static override styles = [shared, progressStyles, partStyles, orientationStyles];

  override firstUpdated(): void {
    // Thumbnails use the page's colours; any change of those starts a transition on the probe.
    this.renderRoot.addEventListener("transitionrun", ({ target }) => {
      if (!(target as Element).classList.contains("probe")) return;
      this.#drawn = new WeakMap();
      void this.#drawThumbnails();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#drawing?.abort();
  }

  override updated(changed: PropertyValues<this>): void {
    if (!changed.has("searched")) return;
    const before = changed.get("searched");
    const { searched } = this;
    if (before?.best !== searched?.best) this.pointed = null;
    if (before?.best !== searched?.best || before?.now !== searched?.now) void this.#drawThumbnails();
  }

  override render(): TemplateResult {
    const { searched, language } = this;
    const words = orientationTexts(language);
    if (searched === null) return html`${nothing}`;
    const { found, busy, isCurrent, isPossible } = searched;
    return html`
      <span class="probe"></span>
      <div class="head">
        <h3>${language.texts.sections.orientation}</h3>
        ${busy === null
          ? html`<button class="small find" ?disabled=${!isPossible} @click=${() => this.#say("cusp-search", null)}>
              ${found === null || isCurrent ? words.find : words.again}
            </button>`
          : nothing}
      </div>
      ${found === null && busy === null ? html`<p class="quiet hint">${words.hint}</p>` : nothing}
      ${found !== null && busy === null && !isCurrent ? html`<p class="stale">${words.stale}</p>` : nothing}
      ${busy === null ? nothing : this.#progress(busy, searched)}
      ${found === null ? nothing : this.#results(searched, found)} ${this.#aims(searched)}
      <p class="visually-hidden" role="status">${this.#announcement(searched)}</p>
    `;
  }

  #aims({ aims, options }: Searched): TemplateResult {
    const { texts } = this.language;
    const words = orientationTexts(this.language);
    const { head } = texts.metrics[options?.metric ?? this.metric];
    const names = { ...words.qualities, layers: words.layers, time: words.time, height: words.height, error: head };
    const weight = (term: keyof typeof names): TemplateResult => html`<label class="field">
      <span>${names[term]}</span>
      <input
        type="range"
        min="0"
        max=${MOST_WEIGHT}
        .value=${live(String(aims.ranking[term]))}
        aria-valuetext=${words.strengths[aims.ranking[term]] ?? nothing}
        @input=${({ target }: Event) => this.#aim({ ranking: { ...aims.ranking, [term]: Number((target as HTMLInputElement).value) } })}
      />
    </label>`;
    return html`<details class="aims">
      <summary>${words.counts}</summary>
      <div class="weights">${RANKED.map(weight)}</div>
      <div class="limits" role="group" aria-labelledby="limits">
        <p class="quiet" id="limits">${words.most}</p>
        ${(Object.keys(LIMITS) as (keyof typeof LIMITS)[]).map((name) => this.#limit(name, aims))}
      </div>
    </details>`;
  }

  /** Field for the maximum of a metric; empty for no limit. */
  #limit(name: keyof typeof LIMITS, aims: Aims): TemplateResult {
    const { limits } = orientationTexts(this.language);
    const field = LIMITS[name];
    return html`<label class="field">
      <span>${limits[name]}</span>
      <input
        type="number"
        min="0"
        step=${name === "islands" ? "1" : "any"}
        .value=${typed(String(aims[field] ?? ""))}
        @change=${({ target }: Event) => {
          const input = target as HTMLInputElement;
          // An invalid entry leaves the aim unchanged.
          if (input.validity.valid) this.#aim({ [field]: input.value === "" ? undefined : input.valueAsNumber });
          else input.reportValidity();
        }}
      />
    </label>`;
  }

  /** The progress bar. While candidates are only rated again, it appears after a delay, since that usually ends sooner. */
  #progress(busy: Busy, { best }: Searched): TemplateResult {
    return html`<div class=${best.length > 0 ? "again quick" : "again"}>
      ${progressBar(busy, this.language, () => this.#say("cusp-search-cancel", null))}
    </div>`;
  }

  #results(searched: Searched, found: Found): TemplateResult {
    const { best, busy, isCurrent } = searched;
    const words = orientationTexts(this.language);
    const fits = found.candidates.some((candidate) => candidate?.excluded === null);
    const isPrintable = found.candidates.some((candidate) => candidate?.metrics != null);
    return html`<div class="results ${busy === null && !isCurrent ? "old" : ""}">
      <div class="globe">
        <cusp-sphere
          .found=${found}
          .best=${best}
          .rotation=${this.rotation}
          .camera=${this.camera}
          .language=${this.language}
          @cusp-look=${(event: CustomEvent<Looked | null>) => (this.looked = event.detail)}
          @cusp-orient=${(event: CustomEvent<Candidate>) => this.#orient(event.detail)}
        ></cusp-sphere>
        ${this.#legend(found)} ${this.#metrics(searched)}
      </div>
      <div class="best">
        ${best.length > 0 ? html`${this.#now(searched)}<h4>${words.best}</h4>` : nothing}
        ${this.isUnpictured && best.length > 0 ? partFailure(this.language, () => void this.#drawThumbnails()) : nothing}
        ${best.map((candidate, i) => this.#choice(candidate, i, searched))}
        ${!fits && busy === null ? html`<p class="quiet">${isPrintable ? words.beyond : words.none}</p>` : nothing}
      </div>
    </div>`;
  }

  #legend({ candidates }: Found): TemplateResult {
    const { format } = this.language;
    const words = orientationTexts(this.language);
    const range = energyRange(candidates);
    const hasExcluded = candidates.some((candidate) => candidate !== null && candidate.excluded !== null);
    return html`<div class="legend">
      ${range === null
        ? nothing
        : html`<span class="quiet">${words.legend}</span>
            <div class="scale">
              <span>${format.tick(range[0])}</span>
              <i ${styled({ background: gradient("to left") })}></i>
              <span>${format.tick(range[1])}</span>
            </div>`}
      <div class="keys quiet">
        <span><svg viewBox="-9 -9 18 18" aria-hidden="true"><path d="M-8 0h16M0 -8v16" /></svg>${words.upright}</span>
        ${hasExcluded ? html`<span><i class="excluded"></i>${words.excluded}</span>` : nothing}
      </div>
    </div>`;
  }

  /** Metrics of the direction or card under the pointer, or else of the current pose. */
  #metrics(searched: Searched): TemplateResult {
    const { looked, pointed, language } = this;
    const words = orientationTexts(language);
    const candidate = looked?.candidate ?? pointed ?? this.#measuredNow(searched);
    const hint = html`<p class="quiet hint"><span class="hovers">${words.point}</span><span class="taps">${words.tap}</span></p>`;
    if (candidate === null) return html`<div class="looked">${hint}</div>`;
    const rows = metricRows(candidate, searched.options?.metric ?? this.metric, language);
    return html`<div class="looked figures" data-direction=${looked === null ? nothing : candidate.direction.join()}>
      ${looked === null ? hint : nothing}
      ${looked === null && pointed === null ? html`<p class="tag">${words.current}</p>` : nothing}
      ${candidate.excluded === null ? nothing : html`<p class="why">${words.why[candidate.excluded]}</p>`}
      <dl>${rows.map(([name, value, help]) => html`<div title=${help ?? nothing}><dt>${name}</dt><dd>${value}</dd></div>`)}</dl>
      ${looked?.isChosen === true && candidate.excluded === null
        ? html`<button class="small" @click=${() => this.#orient(candidate)}>${words.apply}</button>`
        : nothing}
    </div>`;
  }

  /** The current pose, for comparison; without figures until they are known, and while the model is being turned. */
  #now(searched: Searched): TemplateResult {
    const words = orientationTexts(this.language);
    const now = this.#measuredNow(searched);
    return html`<div class="now ${now === null ? "unknown" : ""}" role="group" aria-label=${words.current}>
      <canvas width=${PICTURE_PX} height=${PICTURE_PX} aria-hidden="true"></canvas>
      <span class="what">
        <span class="tag">${words.now}</span>
        ${now === null ? html`<span class="quiet">–</span>` : this.#cost(now, searched)}
        ${now?.excluded == null ? nothing : html`<span class="why">${words.why[now.excluded]}</span>`}
      </span>
    </div>`;
  }

  #choice(candidate: Candidate, place: number, searched: Searched): TemplateResult {
    const { language } = this;
    const words = orientationTexts(language);
    const isApplied = isPose(candidate.rotation, this.rotation);
    return html`<button
      class="pose"
      aria-pressed=${isApplied ? "true" : "false"}
      @click=${() => this.#orient(candidate)}
      @pointerenter=${() => (this.pointed = candidate)}
      @pointerleave=${() => (this.pointed = null)}
      @focus=${() => (this.pointed = candidate)}
      @blur=${() => (this.pointed = null)}
    >
      <canvas width=${PICTURE_PX} height=${PICTURE_PX} aria-hidden="true"></canvas>
      <span class="rank" aria-hidden="true">${place + 1}</span>
      <span class="visually-hidden">${words.rank({ rank: language.format.count(place + 1) })}:</span>
      <span class="what">
        ${this.#cost(candidate, searched)}
        ${(isApplied ? [words.current] : this.#differences(candidate, searched)).map((it) => html`<span class="differs">${it}</span>`)}
      </span>
    </button>`;
  }

  /** Layers and print time of a pose. */
  #cost({ metrics }: Candidate, { options }: Searched): TemplateResult {
    const { language } = this;
    if (metrics === null) return html`${nothing}`;
    const of = (term: Term): string => figure(term, metrics, options?.metric ?? this.metric, language);
    return html`<span class="cost"><strong>${of("layers")} ${language.texts.plan.layers({ count: metrics.layers })}</strong> <span>${of("time")}</span></span>`;
  }

  /** Differences from the current pose in words; empty if that is not measured. */
  #differences({ metrics }: Candidate, searched: Searched): string[] {
    const now = this.#measuredNow(searched)?.metrics ?? null;
    if (metrics === null || now === null) return [];
    return differences(metrics, now, searched.aims.ranking, searched.options?.metric ?? this.metric, this.language);
  }

  #measuredNow({ now }: Searched): Candidate | null {
    return now !== null && isPose(now.rotation, this.rotation) ? now.candidate : null;
  }

  #announcement({ busy, found, best, options }: Searched): string {
    const { looked, language } = this;
    const { texts, format } = language;
    if (looked !== null) {
      const { excluded, metrics } = looked.candidate;
      if (excluded !== null) return orientationTexts(language).why[excluded];
      if (metrics === null) return "";
      const metric = options?.metric ?? this.metric;
      const [time, error] = (["time", "error"] as const).map((term) => figure(term, metrics, metric, language)) as [string, string];
      return orientationTexts(language).said({ layers: metrics.layers, time, head: texts.metrics[metric].head, error });
    }
    if (busy !== null) return texts.progress[busy.stage];
    return found !== null && best.length > 0 ? orientationTexts(language).found({ count: format.count(found.candidates.length) }) : "";
  }

  /** Draws the best poses. The model's positions are fetched for this and then dropped. */
  async #drawThumbnails(): Promise<void> {
    this.#drawing?.abort();
    const { slicer, searched } = this;
    if (slicer === null || searched === null || searched.best.length === 0) return;
    const drawing = new AbortController();
    this.#drawing = drawing;
    const { signal } = drawing;
    // Without thumbnails, the metrics still show; a broken worker is reported elsewhere.
    const positions = await slicer.positions().catch(() => null);
    if (positions === null || signal.aborted) return;
    const pictures = await fetchPictures().catch((error: unknown) => {
      tellPartFailed(this, "pictures", error);
      return null;
    });
    this.isUnpictured = pictures === null;
    if (pictures === null || signal.aborted) return;
    const canvases = [...this.renderRoot.querySelectorAll<HTMLCanvasElement>(".best canvas")];
    // The first card shows the current pose.
    const rotations = [searched.now?.rotation ?? this.rotation, ...searched.best.map(({ rotation }) => rotation)];
    const thumbnails = rotations.flatMap((rotation, i) => {
      const canvas = canvases[i];
      return canvas === undefined || this.#drawn.get(canvas) === rotationText(rotation) ? [] : [[canvas, rotation] as const];
    });
    if (thumbnails.length === 0) return;
    await pictures.drawThumbnails(positions, thumbnails, this, signal);
    if (signal.aborted) return;
    for (const [canvas, rotation] of thumbnails) {
      canvas.dataset["drawn"] = "";
      this.#drawn.set(canvas, rotationText(rotation));
    }
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

/** The known metrics, score and size of a candidate: name, value, and an explanation where needed. */
export function metricRows({ metrics, size_mm, energy }: Candidate, metric: Metric, language: Language): [string, string, string?][] {
  const { texts, format } = language;
  const words = orientationTexts(language);
  const rows: [string, string, string?][] = [];
  if (metrics !== null) {
    const of = (term: Term): string => figure(term, metrics, metric, language);
    rows.push(
      [words.layers, of("layers")],
      [words.time, of("time")],
      [texts.metrics[metric].head, of("error")],
      [words.roughness, of("roughness"), words.roughnessHelp],
      [words.overhang, of("overhang"), words.overhangHelp],
      [words.islands, of("islands"), words.islandsHelp],
      [words.cups, of("cups"), words.cupsHelp],
      [words.qualities.supports, of("supports"), words.supportsHelp],
      [words.qualities.contacts, of("contacts"), words.contactsHelp],
    );
  }
  if (energy !== null) rows.push([words.score, format.tick(energy), words.legend]);
  rows.push([words.size, format.dimensions(size_mm)]);
  return rows;
}

/** Registers the panel's elements once. */
export function defineOrientation(): void {
  define("cusp-orientation", CuspOrientation);
  define("cusp-sphere", CuspSphere);
}
