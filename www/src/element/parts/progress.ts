/** How far a task is, how long it will yet take, and the bar that shows both. */
import { css, html, nothing, type TemplateResult } from "lit";
import type { Stage } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";

export interface Busy {
  task: "open" | "plan" | "export" | "orient";
  /** The model's name. */
  name: string;
  stage: Stage;
  /** 0 to 1 within the stage. */
  fraction: number;
  started_ms: number;
}

const ORDER: Record<Busy["task"], readonly Stage[]> = {
  open: ["load"],
  plan: ["load", "saliency", "ldi", "profile", "plan"],
  export: ["masks"],
  orient: ["orientation"],
};

/** What part of a task its stages take: rays are most of a plan, on any model and machine. */
const SHARE: Record<Stage, number> = {
  ...{ load: 0.05, saliency: 0.05, ldi: 0.7, profile: 0.1, plan: 0.1 },
  ...{ masks: 1, orientation: 1 },
};

/** Before this much time, and this part, a guess of the rest would jump about. */
const GUESS_FROM_MS = 1500;
const GUESS_FROM = 0.05;

export interface Standing {
  /** How far the task is, 0 to 1. */
  done: number;
  /** Seconds that it will yet take; null where nobody can know. */
  left_s: number | null;
}

export function standing({ task, stage, fraction, started_ms }: Busy, now_ms: number): Standing {
  const order = ORDER[task];
  const total = order.reduce((sum, stage) => sum + SHARE[stage], 0);
  const place = order.indexOf(stage);
  // An export may first have to bring back a plan; then its own stages have yet to begin.
  if (place < 0) return { done: 0, left_s: null };
  const before = order.slice(0, place).reduce((sum, stage) => sum + SHARE[stage], 0);
  const done = (before + SHARE[stage] * Math.min(1, Math.max(0, fraction))) / total;
  const elapsed_ms = now_ms - started_ms;
  const isKnown = elapsed_ms >= GUESS_FROM_MS && done >= GUESS_FROM;
  return { done, left_s: isKnown ? ((elapsed_ms / 1000) * (1 - done)) / done : null };
}

export const progressStyles = css`
  .progress {
    display: grid;
    grid-template-columns: 1fr auto;
    align-items: center;
    gap: 0.5rem 1rem;
  }
  .progress .line {
    display: flex;
    justify-content: space-between;
    gap: 1rem;
  }
  .progress .words {
    min-width: 0;
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
  }
  progress {
    display: block;
    width: 100%;
    height: 0.5rem;
    margin-top: 0.375rem;
    border: 0;
    border-radius: 4px;
    overflow: hidden;
    appearance: none;
    background: var(--cusp-line);
  }
  progress::-webkit-progress-bar {
    background: var(--cusp-line);
  }
  progress::-webkit-progress-value {
    background: var(--cusp-accent);
    border-radius: 4px;
  }
  progress::-moz-progress-bar {
    background: var(--cusp-accent);
    border-radius: 4px;
  }
`;

export function progressBar(busy: Busy, { texts, format }: Language, cancel: () => void): TemplateResult {
  const { done, left_s } = standing(busy, performance.now());
  const words = texts.progress[busy.stage];
  return html`<div class="progress" part="progress">
    <div>
      <div class="line">
        <p class="words">${words}</p>
        ${left_s === null
          ? nothing
          : html`<p class="quiet figures left">${texts.progress.left(format.duration(1000 * Math.max(1, left_s)))}</p>`}
      </div>
      <progress max="1" .value=${done} aria-label=${words}></progress>
    </div>
    <button @click=${cancel}>${texts.progress.cancel}</button>
  </div>`;
}
