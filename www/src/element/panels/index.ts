import { define } from "../define.js";
import type { CuspOrientation } from "./orientation-panel.js";
import type { CuspSphere } from "./orientation-sphere.js";
import { CuspModel } from "./model-view.js";
import type { CuspMask } from "./mask-view.js";
import { CuspChart } from "./profile-chart.js";
import { CuspQuality } from "./quality.js";
import { CuspSettings } from "./settings-form.js";

const PARTS = {
  "cusp-settings": CuspSettings,
  "cusp-chart": CuspChart,
  "cusp-quality": CuspQuality,
  "cusp-model": CuspModel,
} as const;

/** Registers the panels' elements once, except those fetched when first shown. Called when an element is created, not on import. */
export function definePanels(): void {
  for (const [name, part] of Object.entries(PARTS)) define(name, part);
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-settings": CuspSettings;
    "cusp-chart": CuspChart;
    "cusp-mask": CuspMask;
    "cusp-quality": CuspQuality;
    "cusp-model": CuspModel;
    "cusp-orientation": CuspOrientation;
    "cusp-sphere": CuspSphere;
  }
}
