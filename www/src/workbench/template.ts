/** Layout of the workbench: the view in the middle, the steps on the left, the result on the right; on a narrow screen, sheets. */
import { html, nothing, type TemplateResult } from "lit";
import {
  announcement,
  besideView,
  chartPanel,
  downloadButton,
  earlierNote,
  fileLine,
  maskPanel,
  modelPanel,
  noticeBox,
  qualityPanel,
  settingsPanel,
  undoButtons,
} from "../element/bound-panels.js";
import { isFilament } from "../api/facts.js";
import { platePanel } from "../element/bound-plate.js";
import { warningsPanel } from "../element/bound-warnings.js";
import type { Facts } from "../element/facts.js";
import { modelCard, uniformOffer } from "../element/panels/model-card.js";
import type { PlotPlace } from "../element/panels/profile-chart.js";
import { comparison, details, figures } from "../element/panels/summary.js";
import { FetchedPanel } from "../element/parts/part.js";
import { problemBox } from "../element/parts/problem-box.js";
import { progressBar } from "../element/parts/progress.js";
import type { Fix } from "../element/state/fixes.js";
import { kindsOf } from "../element/state/checked.js";
import type { Result } from "../element/state/result.js";
import { path, stepPanel } from "./path.js";
import { isOf, type Replaced } from "./one-thickness.js";
import { ANSWERS, isStep, SHEETS, type AnswerPanel, type Sheet, type Step } from "./places.js";
import { tabs } from "./tabs.js";
import { workbenchWords } from "./texts.js";
import { shown } from "../api/visible.js";

/** Fetched with the first file that is saved. */
const afterCode = new FetchedPanel("saved", () => import("./after-download.js"));

/** State of the workbench itself: the open panels, and the position of the chart's plot. */
export interface Bench {
  isWide: boolean;
  /** The step next to the view on a wide screen. */
  step: Step;
  answer: AnswerPanel;
  /** The sheet over the view of a narrow screen; null if none is open. */
  sheet: Sheet | null;
  plot: PlotPlace | null;
  /** The last plan that gave way to uniform layers; null if none did. */
  replaced: Replaced | null;
  /** Goes to a step, from the foot of a neighbouring one or from the row of all. */
  go(step: Step, from: "foot" | "row"): void;
  answers(name: AnswerPanel): void;
  open(sheet: Sheet | null): void;
  placed(plot: PlotPlace): void;
  /** Prepares the selected model for print. */
  prepare(): void;
  /** Name of the print file saved last, until it is dismissed or the plan changes; null without one. */
  saved: string | null;
  dismiss(): void;
}

export function template(facts: Facts, bench: Bench): TemplateResult {
  const { session, isDragging, language } = facts;
  const { isWide } = bench;
  const isEmpty = session.model === null;
  const classes = [isWide ? "wide" : "narrow", isEmpty ? "empty" : "", isDragging ? "dragging" : ""].join(" ");
  return html`
    <div class="bench ${classes}" aria-busy=${session.busy !== null} @cusp-fix=${({ detail }: CustomEvent<Fix>) => (detail.change === null ? bench.go("turn", "row") : undefined)}>
      ${isWide && !isEmpty ? choicesSide(facts, bench) : nothing}
      <section class="stage" aria-label=${isEmpty ? language.texts.open.region : language.texts.view.region}>
        ${isWide || isEmpty ? nothing : path(facts, isStep(bench.sheet) ? bench.sheet : null, false, (step) => bench.go(step, "row"))}
        ${isEmpty ? start(facts) : view(facts, bench)}
        <div class="overlay">${overlay(facts)} ${afterSaving(facts, bench)}</div>
      </section>
      ${isEmpty ? nothing : isWide ? answersSide(facts, bench) : html`${sheet(facts, bench)} ${bar(facts, bench)}`}
    </div>
    ${announcement(facts)}
  `;
}

/** Content before a model is open: that of the page, around the field for the printer. */
function start(facts: Facts): TemplateResult {
  const { busy } = facts.session;
  if (busy !== null) return html`<h2 class="opening">${shown(busy.name)}</h2>`;
  return html`<div class="start">
    <div class="welcome">
      <slot name="start"></slot>
      ${settingsPanel(facts, null, "printer")}
      <slot name="offers"></slot>
    </div>
    <slot name="beside"></slot>
  </div>`;
}

function view(facts: Facts, { isWide, plot, placed }: Bench): TemplateResult {
  const { session, language } = facts;
  return html`${isWide ? nothing : html`<h2 class="model-name" tabindex="-1">${shown(session.model?.name ?? "")}</h2>`}
    <div class="view" part="view">${modelPanel(facts)}</div>
    <cusp-layer-slider
      .shown=${session.shown}
      .layer=${session.layer}
      .plot=${isWide ? plot : null}
      .language=${language}
      @cusp-layer=${(event: CustomEvent<number>) => session.selectLayer(event.detail)}
    ></cusp-layer-slider>
    ${isWide
      ? html`<section class="profile" part="profile" aria-label=${language.texts.chart.region}>
          ${session.shown === null
            ? nothing
            : chartPanel(facts, (event) => {
                besideView(event);
                placed(event.detail);
              })}
        </section>`
      : nothing}`;
}

/** Prominent overlay: problems, notices, and progress. */
function overlay(facts: Facts): TemplateResult {
  const { session, language, problem } = facts;
  const { busy } = session;
  return html`
    ${problem === null ? nothing : problemBox(problem, language, (change) => session.change(change), () => session.dismiss())}
    ${noticeBox(facts)} ${earlierNote(facts)}
    ${busy === null
      ? nothing
      : html`<div class="card progressing ${session.result === null ? "" : "quick"}" part="toast">
          ${progressBar(busy, language, () => session.cancel())}
        </div>`}
  `;
}

function afterSaving(facts: Facts, { saved, dismiss }: Bench): TemplateResult | typeof nothing {
  if (saved === null) return nothing;
  return afterCode.code?.afterDownload(facts, saved, dismiss) ?? afterCode.instead(facts.element, facts.language);
}

function choicesSide(facts: Facts, bench: Bench): TemplateResult {
  const { step } = bench;
  return html`<div class="side choices" part="settings">
    ${modelSection(facts)}
    <div class="tab-row">${prepareButton(facts, bench)} ${undoButtons(facts)}</div>
    ${path(facts, step, true, (step) => bench.go(step, "row"))}
    ${stepPanel(facts, step, (step) => bench.go(step, "foot"), () => undefined)}
  </div>`;
}

/** Button that prepares the selected model, with what it does; disabled while a search or a task runs. */
function prepareButton({ session, language }: Facts, bench: Bench): TemplateResult {
  const words = workbenchWords(language);
  const isPossible = session.busy === null && session.orientation.busy === null && session.orientation.isPossible;
  return html`<div class="prepare">
    <button class="small" ?disabled=${!isPossible} title=${words.prepareHint} @click=${() => bench.prepare()}>${words.prepare}</button>
    ${bench.isWide ? nothing : html`<p class="quiet">${words.prepareHint}</p>`}
  </div>`;
}

function modelSection(facts: Facts): TemplateResult {
  const { session, language, picked } = facts;
  const actions = { picked, openFile: (place: number) => void session.openFile(place) };
  return modelCard(session, language, actions, nothing, platePanel(facts));
}

function answersSide(facts: Facts, bench: Bench): TemplateResult {
  const { answer, answers } = bench;
  const { session, language } = facts;
  const { texts } = language;
  const words = workbenchWords(language);
  return html`<div class="side answers">
    <section class="card plan" part="plan" aria-label=${texts.plan.region}>${plan(facts, bench)}</section>
    <section class="card tabbed" part="quality">
      <div class="tab-row">${tabs(words.answers, ANSWERS, answer, namesOf(facts), "answer", answers)}</div>
      <div class="panel" id="answer" tabindex="0" role="tabpanel" aria-labelledby="tab-${answer}">
        ${session.result === null
          ? html`<p class="quiet">${texts.chart.none}</p>`
          : answer === "quality"
            ? quality(facts, session.result)
            : maskPanel(facts, session.result)}
      </div>
    </section>
  </div>`;
}

/** The result: its figures, file, notes, and details of the computation. */
function plan(facts: Facts, bench: Bench): TemplateResult {
  const { session, language } = facts;
  const { replaced } = bench;
  const { result } = session;
  if (result === null) return noPlan(facts);
  return html`
    <div class="${session.busy?.task === "plan" ? "replanning" : ""}">
      ${figures(result, session.shown ?? result.report, language)} ${uniformOffer(session, language)} ${exposure(facts, result)}
    </div>
    ${downloadButton(facts)} ${findingsLine(facts, bench)} ${fileLine(facts, result)} ${givenWay(facts, result, replaced)} ${warningsPanel(facts)}
    ${comparison(result, language)}
    ${details(facts.element, result, language)}
  `;
}

/** One line about the findings, which leads to them. */
function findingsLine({ session: { checks }, language }: Facts, { go }: Bench): TemplateResult {
  const words = workbenchWords(language).findings;
  const { check } = checks;
  if (check === null) return html`<p class="findings quiet">${checks.error === null ? words.checking : words.unchecked}</p>`;
  const kinds = kindsOf(check);
  return html`<button class="findings link ${check.verdict}" @click=${() => go("check", "row")}>
    ${kinds === 0 ? words.none : check.verdict === "reject" ? words.reject({ kinds }) : words.review({ kinds })}
  </button>`;
}

/** Cost of uniform layers in place of adaptive ones that the printer does not take. */
function givenWay({ session: { settings }, language }: Facts, { report: { layers } }: Result, replaced: Replaced | null): TemplateResult | typeof nothing {
  if (replaced === null || settings.planner !== "uniform" || !isOf(replaced, settings)) return nothing;
  const { count } = language.format;
  const said = { taker: replaced.taker, uniform: count(layers), adaptive: count(replaced.layers) };
  return html`<div class="warning"><p>${workbenchWords(language).oneThickness(said)}</p></div>`;
}

/** Placeholder of the result: the same rows without figures, so that the layout does not shift. */
function noPlan(facts: Facts): TemplateResult {
  const { session, language } = facts;
  const { texts } = language;
  return html`
    <p class="count" aria-hidden="true">–</p>
    <p class="quiet">${session.busy === null ? texts.plan.none : texts.progress[session.busy.stage]}</p>
    ${session.busy === null && session.canPlan
      ? html`<button class="primary" @click=${() => session.replan()}>${texts.plan.make}</button>`
      : nothing}
    ${warningsPanel(facts)}
  `;
}

/** The exposure on which the time is based. */
function exposure({ language }: Facts, { report: { resin } }: Result): TemplateResult | typeof nothing {
  const { exposure_s, layer_mm } = resin;
  if (exposure_s === undefined || layer_mm === undefined) return nothing;
  const { format } = language;
  return html`<p class="exposure quiet">${workbenchWords(language).exposure({ seconds: format.seconds(exposure_s), thickness: format.fine(layer_mm) })}</p>`;
}

/** Uniform layers have a thickness, not a quality. */
function quality(facts: Facts, result: Result): TemplateResult {
  if (result.report.planner === "uniform") return html`<p class="quiet">${facts.language.texts.settings.uniformHint}</p>`;
  return qualityPanel(facts, result);
}

/** Fixed bar of a narrow screen: figures, download, and the panels. */
function bar(facts: Facts, { sheet, open }: Bench): TemplateResult {
  const { session, language } = facts;
  const { result, shown } = session;
  const { texts, format } = language;
  const words = workbenchWords(language);
  const names = namesOf(facts);
  const { layers, print_time_s } = shown ?? { layers: 0, print_time_s: 0 };
  return html`<div class="bar">
    <div class="bar-result">
      <button class="bar-figures" aria-expanded=${sheet === "plan" ? "true" : "false"} @click=${() => open(sheet === "plan" ? null : "plan")}>
        <span class="visually-hidden">${words.more}</span>
        ${result === null
          ? html`<strong>–</strong>`
          : html`${isFilament(result.report.print_file.format) ? nothing : html`<strong>${format.time(print_time_s)}</strong>`}
              <span data-layers=${layers}>${format.count(layers)} ${texts.plan.layers({ count: layers })}</span>`}
      </button>
      ${result === null ? nothing : downloadButton(facts)}
    </div>
    <nav class="bar-panels" aria-label=${words.choices}>
      ${SHEETS.map(
        (name) => html`<button aria-expanded=${name === sheet ? "true" : "false"} @click=${() => open(name === sheet ? null : name)}>
          ${names[name]}
        </button>`,
      )}
    </nav>
  </div>`;
}

function sheet(facts: Facts, bench: Bench): TemplateResult | typeof nothing {
  const { sheet, open } = bench;
  if (sheet === null) return nothing;
  const isOfPath = isStep(sheet);
  return html`<section class="sheet" part=${sheet} data-sheet=${sheet}>
    <div class="tab-row">
      ${isOfPath ? html`<h2 id="step-title" tabindex="-1">${workbenchWords(facts.language).steps[sheet]}</h2> ${undoButtons(facts)}` : html`<h2>${namesOf(facts)[sheet]}</h2>`}
      <button class="small close" @click=${() => open(null)}>${facts.language.texts.notices.close}</button>
    </div>
    ${isOfPath
      ? stepPanel(facts, sheet, (step) => bench.go(step, "foot"), () => open(null), sheet === "turn" ? prepareButton(facts, bench) : nothing)
      : html`<div class="panel">${sheetPanel(facts, bench, sheet)}</div>`}
  </section>`;
}

function namesOf({ language }: Facts): Readonly<Record<Exclude<Sheet, Step>, string>> {
  const { texts } = language;
  const { mask, result } = workbenchWords(language);
  return { profile: texts.chart.region, quality: texts.quality.title, layers: mask, plan: result };
}

function sheetPanel(facts: Facts, bench: Bench, sheet: Exclude<Sheet, Step>): TemplateResult | typeof nothing {
  const { session } = facts;
  if (sheet === "plan") return html`${modelSection(facts)}${plan(facts, bench)}`;
  if (session.result === null) return html`<p class="quiet">${facts.language.texts.chart.none}</p>`;
  if (sheet === "profile") return chartPanel(facts, () => undefined);
  return sheet === "quality" ? quality(facts, session.result) : maskPanel(facts, session.result);
}
