/** Icons of the page's buttons, on a grid of 20 by 20. */
import { html, type TemplateResult } from "lit";

const PATHS = {
  rename: "m4 16 .7-3.2L13 4.5l2.5 2.5-8.3 8.3zM11.2 6.3l2.5 2.5",
  delete: "M5 5l10 10M15 5 5 15",
  applied: "m4.5 10.5 3.5 3.5 7.5-8",
} as const;

export const icon = (name: keyof typeof PATHS): TemplateResult =>
  html`<svg viewBox="0 0 20 20" aria-hidden="true"><path d=${PATHS[name]} /></svg>`;
