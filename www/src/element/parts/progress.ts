/** Progress of a task: its state, estimated time left, and bar. */
import { css, html, nothing, type TemplateResult } from "lit";
import type { Stage } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";

export interface Busy {
  task: "open" | "plan" | "export" | "towers" | "orient";
  name: string;
  stage: Stage;
  /** 0 to 1 within the stage. */
  fraction: number;
  /** 0 to 1 within the task. */
  done: number;
  started_ms: number;
}

/** Before this time and this fraction, an estimate would fluctuate. */
const GUESS_FROM_MS = 1500;
const GUESS_FROM = 0.05;

/** The state after a step. Timing restarts when `done` falls, as it does when an export has replayed its plan. */
export function advanced(busy: Busy, step: Pick<Busy, "stage" | "fraction" | "done">, now_ms: number): Busy {
  return { ...busy, ...step, started_ms: step.done < busy.done ? now_ms : busy.started_ms };
}

/** Estimated seconds left; null while too early to estimate. */
export function secondsLeft({ done, started_ms }: Busy, now_ms: number): number | null {
  const elapsed_ms = now_ms - started_ms;
  const isKnown = elapsed_ms >= GUESS_FROM_MS && done >= GUESS_FROM;
  return isKnown ? ((elapsed_ms / 1000) * (1 - done)) / done : null;
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
  const left_s = secondsLeft(busy, performance.now());
  const words = texts.progress[busy.stage];
  return html`<div class="progress" part="progress">
    <div>
      <div class="line">
        <p class="words">${words}</p>
        ${left_s === null
          ? nothing
          : html`<p class="quiet figures left">${texts.progress.left({ seconds: format.duration(1000 * Math.max(1, left_s)) })}</p>`}
      </div>
      <progress max="1" .value=${busy.done} aria-label=${words}></progress>
    </div>
    <button @click=${cancel}>${texts.progress.cancel}</button>
  </div>`;
}
