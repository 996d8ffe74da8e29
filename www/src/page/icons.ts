/** Icons of the page's buttons, on a grid of 20 × 20. */
import { html, type TemplateResult } from "lit";

const PATHS = {
  rename: "m4 16 .7-3.2L13 4.5l2.5 2.5-8.3 8.3zM11.2 6.3l2.5 2.5",
  delete: "M5 5l10 10M15 5 5 15",
  applied: "m4.5 10.5 3.5 3.5 7.5-8",
  recent: "M10 5.5V10l3 2M3.5 10a6.5 6.5 0 1 0 2-4.7M3.5 3.5v3h3",
  saved: "M5.5 3.5h9v13L10 13l-4.5 3.5z",
} as const;

export type IconName = keyof typeof PATHS;

export const icon = (name: IconName): TemplateResult =>
  html`<svg viewBox="0 0 20 20" aria-hidden="true"><path d=${PATHS[name]} /></svg>`;
