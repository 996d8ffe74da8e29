/** The path from a model to its print file: the steps, and the panel of each. */
import { html, nothing, type TemplateResult } from "lit";
import { isFilament } from "../api/facts.js";
import { orientationPanel, settingsPanel, takeUp } from "../element/bound-panels.js";
import { findingsPanel } from "../element/bound-findings.js";
import type { Facts } from "../element/facts.js";
import type { Fields } from "../element/panels/settings-form.js";
import { STEPS, type HandTool, type Step } from "./places.js";
import { stepStates, type Mark } from "./step-states.js";
import { workbenchWords } from "./texts.js";

/** Fields of the settings form in each step. */
const FIELDS = { hollow: "hollow", support: "supports", slice: "slice" } as const satisfies Partial<Record<Step, Fields>>;

/** Tool of the view in each step. */
const TOOLS: Partial<Record<Step, HandTool>> = { turn: "rotate", hollow: "drains", support: "supports" };

/**
 * @param current the step whose panel is shown
 * @param isWide true if the steps are a column, with room for their states
 */
export function path(facts: Facts, current: Step | null, isWide: boolean, go: (step: Step) => void): TemplateResult {
  const { session, language } = facts;
  const words = workbenchWords(language);
  const states = stepStates(session, language);
  return html`<nav class="path" aria-label=${words.path}>
    <ol>
      ${STEPS.map((step, i) => {
        const { words: said, mark } = states[step];
        return html`<li>
          <button
            aria-current=${step === current ? "step" : nothing}
            @click=${() => go(step)}
          >
            <span class="badge ${mark ?? ""}" aria-hidden="true">${badge(mark, language.format.count(i + 1))}</span>
            <span class="name" id=${isWide && step === current ? "step-title" : nothing}>${words.steps[step]}</span>
            ${isWide ? html`<span class="state">${said}</span>` : nothing}
          </button>
        </li>`;
      })}
    </ol>
  </nav>`;
}

function badge(mark: Mark, number: string): string | TemplateResult {
  if (mark === null) return number;
  return mark !== "done" ? "!" : html`<svg viewBox="0 0 20 20"><path d="m4.5 10.5 4 4 7-8.5" /></svg>`;
}

/**
 * The panel of a step, with buttons to the previous and next steps.
 *
 * @param taken called when a tool of the view was activated
 * @param first shown above the step's own content
 */
export function stepPanel(facts: Facts, step: Step, go: (step: Step) => void, taken: () => void, first: TemplateResult | typeof nothing = nothing): TemplateResult {
  const { language } = facts;
  const words = workbenchWords(language);
  const isUnused = isFilament(facts.session.settings.format) && (step === "hollow" || step === "support");
  const byHand = isUnused ? nothing : handButton(facts, step, taken);
  const foot = stepFoot(facts, step, go);
  const isLast = step === STEPS.at(-1);
  return html`<div class="panel" tabindex="0" role="group" aria-labelledby="step-title">
      ${step === "slice" ? nothing : html`<p class="hint quiet">${isUnused ? words.filament : words.hints[step]}</p>`}
      ${first} ${isUnused ? nothing : contentOf(facts, step)} ${byHand}
      ${isLast ? foot : nothing}
    </div>
    ${isLast ? nothing : foot}`;
}

/** Button that activates the tool of a step, if the tool applies. */
function handButton({ session: { model, settings, plate }, language }: Facts, step: Step, taken: () => void): TemplateResult | typeof nothing {
  const tool = TOOLS[step];
  if (tool === undefined || model === null || (step === "hollow" && settings.wall.trim() === "")) return nothing;
  // On a plate of several copies, points cannot be assigned to a single model.
  if (tool !== "rotate" && plate.copies.length > 0) return nothing;
  const take = ({ target }: Event): void => {
    takeUp(target, tool);
    taken();
  };
  return html`<button class="small by-hand" @click=${take}>${workbenchWords(language).byHand[tool]}</button>`;
}

function contentOf(facts: Facts, step: Step): TemplateResult | typeof nothing {
  const { session, language } = facts;
  if (step === "turn") return orientationPanel(facts);
  if (step !== "check") return html`${settingsPanel(facts, null, FIELDS[step])} ${step === "support" ? missing(facts) : nothing}`;
  return session.result === null ? html`<p class="quiet">${language.texts.chart.none}</p>` : findingsPanel(facts);
}

/** Number of points that no support reaches. */
function missing({ session: { result, settings }, language }: Facts): TemplateResult | typeof nothing {
  const points = settings.supports === "none" ? 0 : (result?.own?.supported?.unreached.length ?? 0);
  return points === 0 ? nothing : html`<p class="missing">${workbenchWords(language).states.missing({ points })}</p>`;
}

function stepFoot({ language }: Facts, step: Step, go: (step: Step) => void): TemplateResult {
  const words = workbenchWords(language);
  const at = STEPS.indexOf(step);
  const [before, after] = [STEPS[at - 1], STEPS[at + 1]];
  return html`<div class="step-foot">
    ${before === undefined ? nothing : html`<button class="small" @click=${() => go(before)}>${words.back}</button>`}
    ${after === undefined ? nothing : html`<button class="small next" @click=${() => go(after)}>${words.next({ step: words.steps[after] })}</button>`}
  </div>`;
}
