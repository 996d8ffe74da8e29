/** The box for a failure: its explanation, and the buttons of its offers. */
import { css, html, nothing, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import type { Offer } from "../state/offers.js";
import type { Problem } from "../state/problem.js";
import type { Settings } from "../state/settings.js";

export const problemStyles = css`
  .message {
    display: flex;
    flex-wrap: wrap;
    align-items: start;
    justify-content: space-between;
    gap: 1rem;
    margin-bottom: 1rem;
    padding: 0.875rem 1.25rem;
    border: 1px solid var(--cusp-line);
    border-inline-start-width: 4px;
    border-radius: 8px;
  }
  .message > :first-child {
    flex: 1 1 12rem;
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .message h2 {
    font-size: 1rem;
  }
  .problem {
    border-color: var(--cusp-bad);
    background: var(--cusp-bad-wash);
  }
  .notice {
    align-items: center;
    border-color: var(--cusp-accent);
    background: var(--cusp-note-wash);
  }
  .offers {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem;
    margin-top: 0.625rem;
  }
`;

export function offerButtons(offers: readonly Offer[], change: (change: Partial<Settings>) => void): TemplateResult | typeof nothing {
  if (offers.length === 0) return nothing;
  return html`<div class="offers">
    ${offers.map((offer) => html`<button class="small" @click=${() => change(offer.change)}>${offer.label}</button>`)}
  </div>`;
}

export function problemBox(
  { code, title, text, offers }: Problem,
  { texts }: Language,
  change: (change: Partial<Settings>) => void,
  close: () => void,
): TemplateResult {
  return html`<section class="message problem" part="problem" role="alert" data-code=${code}>
    <div>
      <h2>${title}</h2>
      <p>${text}</p>
      ${offerButtons(offers, change)}
    </div>
    <button class="small" @click=${close}>${texts.notices.close}</button>
  </section>`;
}
