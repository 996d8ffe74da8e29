/** Layout of `<cusp-slicer>`: its panels as cards, as a function of its session. */
import { html, nothing, type TemplateResult } from "lit";
import {
  announcement,
  chartPanel,
  downloadButton,
  earlierNote,
  fileLine,
  maskPanel,
  modelPanel,
  noticeBox,
  orientationPanel,
  qualityPanel,
  settingsPanel,
  undoButtons,
} from "./bound-panels.js";
import { findingsPanel } from "./bound-findings.js";
import { platePanel } from "./bound-plate.js";
import { warningsPanel } from "./bound-warnings.js";
import type { Facts } from "./facts.js";
import { modelCard, uniformOffer } from "./panels/model-card.js";
import { priceRow } from "./panels/price-row.js";
import { hasPlace } from "./panels/settings-form.js";
import { comparison, details, figures } from "./panels/summary.js";
import { layersPicture } from "./parts/layers-picture.js";
import { problemBox } from "./parts/problem-box.js";
import { progressBar } from "./parts/progress.js";
import { MODEL_FILES } from "./state/choice.js";
import type { Result } from "./state/result.js";
import { shown } from "../api/visible.js";

interface Drawn extends Facts {
  /** True if there is room for settings next to the results. */
  isWide: boolean;
  /** True if the problem is shown next to the setting that caused it. */
  isBeside: boolean;
}

export function template(facts: Facts, isWide: boolean): TemplateResult {
  const { session, panels, problem, isDragging } = facts;
  const { model, result, settings, busy } = session;
  // Without a plan, the problem is shown in the middle, not among the settings.
  const isBeside = problem !== null && result !== null && panels.has("settings") && hasPlace(problem, settings, session);
  const drawn = { ...facts, isWide, isBeside };
  return html`
    <div class="slicer ${isDragging ? "dragging" : ""}" aria-busy=${busy !== null}>
      ${problem === null || isBeside ? nothing : problemOf(drawn)} ${noticeBox(facts)}
      ${model === null ? start(drawn) : work(drawn)}
    </div>
    ${announcement(facts)}
  `;
}

function problemOf({ session, problem, language }: Drawn): TemplateResult | typeof nothing {
  if (problem === null) return nothing;
  return problemBox(problem, language, (change) => session.change(change), () => session.dismiss());
}

/** Content before a model is open. */
function start({ session, language, panels, picked }: Drawn): TemplateResult {
  const { busy } = session;
  const { texts } = language;
  return html`<section class="start" aria-label=${texts.open.region}>
    ${busy !== null
      ? html`<div class="card waiting">
          <h2>${shown(busy.name)}</h2>
          ${progressBar(busy, language, () => session.cancel())}
        </div>`
      : panels.has("open")
        ? html`<label class="drop" part="drop">
            <input class="visually-hidden" type="file" accept=${MODEL_FILES} multiple @change=${picked} />
            ${layersPicture}
            <span class="drop-title">${texts.open.drop}</span>
            <span class="button primary">${texts.open.choose}</span>
          </label>`
        : nothing}
    <slot name="empty"></slot>
  </section>`;
}

function work(drawn: Drawn): TemplateResult {
  const { session, panels } = drawn;
  const { busy, result } = session;
  const isPlain = !panels.has("model") && !panels.has("plate") && !panels.has("settings");
  return html`<div class="work ${isPlain ? "plain" : ""}">
    ${modelsCard(drawn)} ${panels.has("settings") ? settingsCard(drawn) : nothing}
    <div class="results ${busy?.task === "plan" && result !== null ? "replanning" : ""}">
      ${result === null ? waiting(drawn) : results(drawn, result)}
    </div>
    ${busy !== null && result !== null
      ? html`<div class="card toast" part="toast">${progressBar(busy, drawn.language, () => session.cancel())}</div>`
      : nothing}
  </div>`;
}

/** The open model, with the list of all models. */
function modelsCard(drawn: Drawn): TemplateResult | typeof nothing {
  const { session, language, panels, picked } = drawn;
  const list = panels.has("plate") ? platePanel(drawn) : nothing;
  if (!panels.has("model")) return list === nothing ? nothing : html`<section class="card model" part="model">${list}</section>`;
  const actions = { picked, openFile: (place: number) => void session.openFile(place) };
  return modelCard(session, language, actions, warningsPanel(drawn), list);
}

function settingsCard(drawn: Drawn): TemplateResult {
  const { language, problem, isWide, isBeside } = drawn;
  return html`<details class="card settings" part="settings" ?open=${isWide || isBeside}>
    <summary><h2>${language.texts.settings.title}</h2></summary>
    ${undoButtons(drawn)} ${settingsPanel(drawn, isBeside ? problem : null)}
  </details>`;
}

/** Content in place of results while there is no plan. */
function waiting(drawn: Drawn): TemplateResult {
  const { session, language, panels } = drawn;
  const { busy } = session;
  const { texts } = language;
  return html`<section class="card waiting span first">
      ${busy !== null
        ? progressBar(busy, language, () => session.cancel())
        : html`<p class="quiet">${texts.plan.none}</p>
            ${session.canPlan ? html`<button class="primary" @click=${() => session.replan()}>${texts.plan.make}</button>` : nothing}`}
    </section>
    ${panels.has("view") && busy === null && !session.canPlan ? viewCard(drawn) : nothing}`;
}

function viewCard(drawn: Drawn): TemplateResult {
  return html`<section class="card" part="view" aria-label=${drawn.language.texts.view.region}>${modelPanel(drawn)}</section>`;
}

function results(drawn: Drawn, result: Result): TemplateResult {
  const { session, language, panels } = drawn;
  const { texts } = language;
  return html`
    ${panels.has("plan")
      ? html`<section class="card span first" part="plan" aria-label=${texts.plan.region}>
          ${earlierNote(drawn)}
          <div class="answer">
            ${figures(result, session.shown ?? result.report, language)} ${uniformOffer(session, language)} ${priceRow(session.pricing.price, language)} ${downloadButton(drawn)} ${fileLine(drawn, result)}
          </div>
          ${comparison(result, language)}
          ${panels.has("model") ? nothing : warningsPanel(drawn)} ${details(drawn.element, result, language)}
        </section>`
      : nothing}
    ${panels.has("view") ? viewCard(drawn) : nothing}
    ${panels.has("profile")
      ? html`<section class="card" part="profile" aria-label=${texts.chart.region}>${chartPanel(drawn)}</section>`
      : nothing}
    ${panels.has("orientation")
      ? html`<section class="card span" part="orientation" aria-label=${texts.sections.orientation}>${orientationPanel(drawn)}</section>`
      : nothing}
    ${panels.has("quality") && result.report.planner !== "uniform"
      ? html`<section class="card" part="quality" aria-label=${texts.quality.title}>
          ${qualityPanel(drawn, result)}
        </section>`
      : nothing}
    ${panels.has("layers")
      ? html`<section class="card" part="layers" aria-label=${texts.mask.region}>${maskPanel(drawn, result)}</section>`
      : nothing}
    ${panels.has("findings") ? findingsCard(drawn) : nothing}
  `;
}

/** Collapsed, and nothing is checked, until a user opens it. */
function findingsCard(drawn: Drawn): TemplateResult {
  const { session, language } = drawn;
  const toggled = ({ target }: Event): void => void (session.checks.isOpen = (target as HTMLDetailsElement).open);
  return html`<details class="card findings" part="findings" @toggle=${toggled}>
    <summary><h2>${language.texts.findings.title}</h2></summary>
    ${session.checks.isOpen ? findingsPanel(drawn) : nothing}
  </details>`;
}
