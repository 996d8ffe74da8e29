/** Parts that are fetched when first shown, and what a panel shows if one cannot be loaded. */
import { css, html, type TemplateResult } from "lit";
import { said, SlicerError } from "../../api/error.js";
import type { Language } from "../../texts/index.js";

/** The 3-D view; the pictures of the best orientations; the chart of the profile. */
export type Part = "view" | "pictures" | "chart";

export function partError(part: Part, cause: unknown): SlicerError {
  const system = said(cause);
  return new SlicerError("part-failed", `a part of the page could not be loaded: ${part} (${system})`, { part, system });
}

/** Fires `cusp-error` from the panel. It reaches the page as an event of the element, whose plan stays. */
export function tellPartFailed(panel: HTMLElement, part: Part, cause: unknown): void {
  const detail = partError(part, cause);
  panel.dispatchEvent(new CustomEvent("cusp-error", { detail, bubbles: true, composed: true }));
}

export function partFailure({ texts }: Language, again: () => void): TemplateResult {
  return html`<div class="part-failed" role="alert">
    <p>${texts.notices.partFailed}</p>
    <button class="small" @click=${again}>${texts.offers.again}</button>
  </div>`;
}

export const partStyles = css`
  .part-failed {
    align-self: center;
    justify-self: center;
    max-width: 28rem;
    padding: 1rem;
    text-align: center;
  }
  .part-failed p {
    margin-bottom: 0.75rem;
  }
`;
