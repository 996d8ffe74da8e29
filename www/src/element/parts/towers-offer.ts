/** Offer of test towers: their button, and instructions for measuring them. */
import { html, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";

/** State of the towers: can be written, are being written, or must wait for a task or a setting. */
export type TowersState = "ready" | "writing" | "waiting";

export function towersOffer(state: TowersState, { texts: { towers: words }, format: { size } }: Language, save: () => void): TemplateResult {
  const isWriting = state === "writing";
  return html`<div class="towers">
    <button class="small" aria-describedby="towers" aria-busy=${isWriting} ?disabled=${state !== "ready"} @click=${save}>
      ${isWriting ? words.writing : words.download}
    </button>
    <p id="towers" class="quiet">${words.measure({ half: size(0.5), one: size(1), oneAndHalf: size(1.5), two: size(2) })}</p>
  </div>`;
}
