/** The stages in words, and the bar that shows them. */
import { css, html, type TemplateResult } from "lit";
import type { Busy } from "./session.js";
import type { Stage } from "../api/wire.js";

const WORDS: Record<Stage, string> = {
  load: "Reading the model",
  ldi: "Casting rays through it",
  profile: "Measuring the surface",
  plan: "Planning the layers",
  masks: "Drawing the masks",
};

const ORDER: Record<Busy["task"], readonly Stage[]> = {
  open: ["load", "ldi", "profile", "plan"],
  plan: ["load", "ldi", "profile", "plan"],
  archive: ["masks"],
};

/** Where a task stands: its words, and how far it is, 0 to 1, its stages counted alike. */
export function standing({ task, stage, fraction }: Busy): { words: string; done: number } {
  const order = ORDER[task];
  const place = order.indexOf(stage);
  // A download may first have to bring back a plan; then its own stages have yet to begin.
  const done = place < 0 ? 0 : (place + Math.min(1, Math.max(0, fraction))) / order.length;
  return { words: WORDS[stage], done };
}

export const progressStyles = css`
  .progress {
    display: grid;
    grid-template-columns: 1fr auto;
    align-items: center;
    gap: 0.5rem 1rem;
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

export function progressBar(busy: Busy, cancel: () => void): TemplateResult {
  const { words, done } = standing(busy);
  return html`<div class="progress">
    <div>
      <p class="words">${words}</p>
      <progress max="1" .value=${done} aria-label=${words}></progress>
    </div>
    <button @click=${cancel}>Cancel</button>
  </div>`;
}
