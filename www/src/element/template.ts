/** The element's template, as a function of its session. */
import { html, nothing, type TemplateResult } from "lit";
import type { Slicer } from "../api/index.js";
import type { Candidate } from "../api/wire.js";
import type { Language } from "../texts/index.js";
import { sentence } from "./state/comparison.js";
import type { RotateDetail } from "../view/events.js";
import type { PaletteName } from "../view/legend/palette.js";
import type { Rotation } from "../view/scene/pose.js";
import type { Searched } from "./panels/orientation-panel.js";
import type { Aims } from "./state/orientation.js";
import { modelCard, warnings } from "./panels/model-card.js";
import type { Scaled } from "./panels/model-view.js";
import type { Painted } from "./events.js";
import type { Panel } from "./state/panel-names.js";
import { fileWords } from "./parts/file-words.js";
import { explain, type Problem } from "./state/problem.js";
import { problemBox } from "./parts/problem-box.js";
import type { PlotPlace } from "./panels/profile-chart.js";
import { progressBar } from "./parts/progress.js";
import { printerOf } from "./state/printer.js";
import type { Result } from "./state/result.js";
import type { Session } from "./state/session.js";
import { hasPlace } from "./panels/settings-form.js";
import { UPRIGHT } from "../view/scene/turn.js";
import { quaternion } from "./state/settings.js";
import type { Settings } from "./state/settings.js";
import { details, summary } from "./panels/summary.js";

export interface Facts {
  session: Session;
  language: Language;
  panels: ReadonlySet<Panel>;
  slicer: Slicer;
  /** Whether there is room for settings beside the results. */
  isWide: boolean;
  isDragging: boolean;
  picked(event: Event): void;
  save(): void;
  saveTowers(): void;
  saveWeights(): void;
}

interface Drawn extends Facts {
  problem: Problem | null;
  /** Whether the problem is shown beside the setting that caused it. */
  isBeside: boolean;
}

export function template(facts: Facts): TemplateResult {
  const { session, language, panels, isDragging } = facts;
  const { failure, model, settings } = session;
  const problem = failure === null ? null : explain(failure, language, session.fixed);
  const isBeside = problem !== null && model !== null && panels.has("settings") && hasPlace(problem, settings, session);
  const drawn = { ...facts, problem, isBeside };
  return html`
    <div class="slicer ${isDragging ? "dragging" : ""}" aria-busy=${session.busy !== null}>
      ${problem === null || isBeside
        ? nothing
        : problemBox(problem, language, (change) => session.change(change), () => session.dismiss())}
      ${notice(drawn)} ${model === null ? start(drawn) : work(drawn)}
    </div>
    <p class="visually-hidden" role="status" aria-live="polite">${announcement(drawn)}</p>
  `;
}

function notice({ session, language: { texts } }: Drawn): TemplateResult | typeof nothing {
  if (session.notice === null) return nothing;
  return html`<section class="message notice">
    <p>${texts.notices[session.notice]}</p>
    <button class="small" @click=${() => session.dismiss()}>${texts.notices.close}</button>
  </section>`;
}

/** The element before a model is open. */
function start({ session, language, panels, picked }: Drawn): TemplateResult {
  const { busy } = session;
  const { texts } = language;
  return html`<section class="start" aria-label=${texts.open.region}>
    ${busy !== null
      ? html`<div class="card waiting">
          <h2>${busy.name}</h2>
          ${progressBar(busy, language, () => session.cancel())}
        </div>`
      : panels.has("open")
        ? html`<label class="drop" part="drop">
            <input class="visually-hidden" type="file" accept=".stl,model/stl" multiple @change=${picked} />
            ${layersPicture}
            <span class="drop-title">${texts.open.drop}</span>
            <span class="button primary">${texts.open.choose}</span>
          </label>`
        : nothing}
    <slot name="empty"></slot>
  </section>`;
}

function work(drawn: Drawn): TemplateResult {
  const { session, language, panels, isWide, picked, saveTowers } = drawn;
  const { busy, result } = session;
  const isPlain = !panels.has("model") && !panels.has("settings");
  return html`<div class="work ${isPlain ? "plain" : ""}">
    ${panels.has("model")
      ? modelCard(session, language, { picked, openFile: (place) => void session.openFile(place), saveTowers })
      : nothing}
    ${panels.has("settings") ? settingsCard(drawn, isWide) : nothing}
    <div class="results ${busy?.task === "plan" && result !== null ? "replanning" : ""}">
      ${result === null ? waiting(drawn) : results(drawn, result)}
    </div>
    ${busy !== null && result !== null
      ? html`<div class="card toast" part="toast">${progressBar(busy, language, () => session.cancel())}</div>`
      : nothing}
  </div>`;
}

function settingsCard({ session, language, problem, isBeside, saveTowers }: Drawn, isWide: boolean): TemplateResult {
  const { texts } = language;
  const button = (name: string, isPossible: boolean, act: () => void, path: string): TemplateResult => html`<button
    class="small"
    aria-label=${name}
    title=${name}
    ?disabled=${!isPossible}
    @click=${act}
  >
    <svg viewBox="0 0 20 20" aria-hidden="true"><path d=${path} /></svg>
  </button>`;
  return html`<details class="card settings" part="settings" ?open=${isWide || isBeside}>
    <summary><h2>${texts.settings.title}</h2></summary>
    <div class="steps">
      ${button(texts.settings.undo, session.canUndo, () => session.undo(), "M8 5 4 9l4 4M4 9h8a4 4 0 0 1 0 8H9")}
      ${button(texts.settings.redo, session.canRedo, () => session.redo(), "m12 5 4 4-4 4m4-4H8a4 4 0 0 0 0 8h3")}
    </div>
    <cusp-settings
      .settings=${session.settings}
      .faults=${session.faults}
      .info=${session.model?.info ?? null}
      .taken=${session.taken}
      .offered=${session}
      .fixed=${session.fixed}
      .problem=${isBeside ? problem : null}
      .towers=${session.towers}
      .language=${language}
      @cusp-settings=${(event: CustomEvent<Partial<Settings>>) => session.change(event.detail)}
      @cusp-open-printer=${(event: CustomEvent<File>) => void session.openPrinter(event.detail)}
      @cusp-towers=${saveTowers}
      @cusp-dismiss=${() => session.dismiss()}
    ></cusp-settings>
  </details>`;
}

function waiting({ session, language }: Drawn): TemplateResult {
  const { busy } = session;
  const { texts } = language;
  return html`<section class="card waiting span first">
    ${busy !== null
      ? progressBar(busy, language, () => session.cancel())
      : html`<p class="quiet">${texts.plan.none}</p>
          <button class="primary" @click=${() => session.replan()}>${texts.plan.make}</button>`}
  </section>`;
}

function results(drawn: Drawn, result: Result): TemplateResult {
  const { session, language, panels, slicer, save, saveTowers, saveWeights } = drawn;
  const { layer, mask, busy, curve, shown, turning, settings } = session;
  const { texts } = language;
  const selectLayer = (event: CustomEvent<number>): void => session.selectLayer(event.detail);
  const download = html`<button class="primary download" aria-describedby="file" ?disabled=${busy !== null} @click=${save}>
      ${texts.plan.download}
    </button>
    <p id="file" class="quiet">${fileWords(result, session.printers, language)}</p>`;
  return html`
    ${panels.has("plan")
      ? html`<section class="card span first" part="plan" aria-label=${texts.plan.region}>
          ${summary(result, shown ?? result.report, language, earlier(drawn), download)}
          ${panels.has("model") ? nothing : warnings(session, language, saveTowers)} ${details(result, language)}
        </section>`
      : nothing}
    ${panels.has("view")
      ? html`<section class="card" part="view" aria-label=${texts.view.region}>
          <cusp-model
            .slicer=${slicer}
            .model=${session.model}
            .shown=${shown}
            .layer=${layer}
            .rotation=${turning ?? rotationOf(settings.rotation)}
            .scaled=${scaledOf(session)}
            .printer=${printerOf(settings.printer, session.printers)}
            .settings=${settings}
            .weights=${session.weights}
            .language=${language}
            @cusp-paint=${(event: CustomEvent<Painted>) => painted(session, event)}
            @cusp-settings=${(event: CustomEvent<Partial<Settings>>) => session.change(event.detail)}
            @cusp-open-weights=${(event: CustomEvent<File>) => void session.openWeights(event.detail)}
            @cusp-save-weights=${saveWeights}
            @cusp-rotate=${(event: CustomEvent<RotateDetail>) => session.turn(event.detail.rotation, event.detail.final)}
            @cusp-layer=${selectLayer}
            @cusp-camera=${seen}
            @cusp-palette=${recoloured}
          ></cusp-model>
        </section>`
      : nothing}
    ${panels.has("profile")
      ? html`<section class="card" part="profile" aria-label=${texts.chart.region}>
          <cusp-chart
            .data=${shown}
            .layer=${layer}
            .language=${language}
            @cusp-layer=${selectLayer}
            @cusp-plot=${placed}
          ></cusp-chart>
        </section>`
      : nothing}
    ${panels.has("orientation")
      ? html`<section class="card span" part="orientation" aria-label=${texts.orientation.title}>
          <cusp-orientation
            .slicer=${slicer}
            .searched=${searchedOf(session)}
            .metric=${settings.metric}
            .rotation=${turning ?? rotationOf(settings.rotation)}
            .language=${language}
            @cusp-search=${() => session.orientation.start()}
            @cusp-search-cancel=${() => session.orientation.cancel()}
            @cusp-aims=${(event: CustomEvent<Partial<Aims>>) => session.orientation.aim(event.detail)}
            @cusp-orient=${(event: CustomEvent<Candidate>) => session.orient(event.detail)}
          ></cusp-orientation>
        </section>`
      : nothing}
    ${panels.has("quality") && result.report.planner !== "uniform"
      ? html`<section class="card" part="quality" aria-label=${texts.quality.title}>
          <cusp-quality
            .points=${curve}
            .result=${result}
            .isFixed=${session.fixed.has("tolerances")}
            .language=${language}
            @cusp-point=${(event: CustomEvent<number>) => session.takePoint(event.detail)}
          ></cusp-quality>
        </section>`
      : nothing}
    ${panels.has("layers")
      ? html`<section class="card" part="layers" aria-label=${texts.mask.region}>
          <cusp-mask
            .mask=${mask}
            .report=${result.report}
            .limits=${result.limits}
            .layer=${layer}
            .language=${language}
            @cusp-layer=${selectLayer}
          ></cusp-mask>
        </section>`
      : nothing}
  `;
}

/** The session reports the weights, and the element fires the event again. */
function painted(session: Session, event: CustomEvent<Painted>): void {
  session.setWeights(event.detail.weights, event.detail.final);
}

/** Passes the chart's position and heights to the view beside it. */
function placed({ target, detail }: CustomEvent<PlotPlace>): void {
  const view = beside(target, "cusp-model");
  if (view !== null) view.plot = detail;
}

/** Passes the view's camera to the orientation panel beside it. */
function seen({ target, detail }: CustomEvent<Rotation>): void {
  const panel = beside(target, "cusp-orientation");
  if (panel !== null) panel.camera = detail;
}

function recoloured({ target, detail }: CustomEvent<PaletteName>): void {
  const panel = beside(target, "cusp-orientation");
  if (panel !== null) panel.palette = detail;
}

function beside<Name extends "cusp-model" | "cusp-orientation">(target: EventTarget | null, name: Name): HTMLElementTagNameMap[Name] | null {
  return ((target as Element).getRootNode() as ShadowRoot).querySelector(name);
}

function searchedOf({ orientation: { aims, found, best, busy, isCurrent, isPossible, options } }: Session): Searched {
  return { aims, found, best, busy, isCurrent, isPossible, options };
}

const rotations = new Map<string, Rotation>();

/** Cached, since a new array would count as a new rotation. */
function rotationOf(text: string): Rotation {
  let rotation = rotations.get(text);
  if (rotation === undefined) rotations.set(text, (rotation = quaternion(text) ?? UPRIGHT));
  return rotation;
}

/** A requested height is that of the model in its pose, or in the one that it is being turned to. */
function scaledOf({ result, turning, shown }: Session): Scaled | null {
  if (result?.options.height_mm === undefined) return null;
  const height_mm = turning === null ? result.report.height_mm : (shown?.z_mm.at(-1) ?? result.report.height_mm);
  return { height_mm, rotation: turning ?? result.options.rotation ?? UPRIGHT };
}

/** The note on a result that is not for the settings shown. */
function earlier({ session, problem, language: { texts } }: Drawn): TemplateResult | typeof nothing {
  if (!session.earlier) return nothing;
  // Without a fault or a problem, the plan was cancelled: only then does trying again help.
  const again = Object.keys(session.faults).length === 0 && problem === null;
  return html`<p class="earlier">
    ${texts.plan.earlier}
    ${again ? html`<button class="link" @click=${() => session.replan()}>${texts.plan.again}</button>` : nothing}
  </p>`;
}

/** For screen readers: the start and the outcome of a task, not every step. */
function announcement({ session, language }: Drawn): string {
  const { busy, result, notice, earlier } = session;
  const { texts, format } = language;
  if (busy !== null) return busy.task === "open" ? texts.open.opening(busy.name) : texts.progress[busy.stage];
  if (notice !== null) return texts.notices[notice];
  if (result === null || earlier) return "";
  const { layers, print_time_s } = result.report;
  return `${texts.plan.said(layers, format.time(print_time_s))} ${sentence(result, language)}`;
}

/** The icon above the drop zone: a vase in layers. */
const layersPicture = html`<svg viewBox="0 0 64 56" width="80" height="70" aria-hidden="true">
  <rect x="22" y="2" width="20" height="3" fill="#c82a36" />
  <rect x="17" y="6" width="30" height="3" fill="#ef6c48" />
  <rect x="13" y="10" width="38" height="4" fill="#fcba67" />
  <rect x="11" y="15" width="42" height="6" fill="#b0d6e2" />
  <rect x="10" y="22" width="44" height="8" fill="#6aa1ce" />
  <rect x="10" y="31" width="44" height="9" fill="#3662ac" />
  <rect x="12" y="41" width="40" height="6" fill="#6aa1ce" />
  <rect x="16" y="48" width="32" height="3" fill="#fcba67" />
  <rect x="22" y="52" width="20" height="2" fill="#c82a36" />
</svg>`;
