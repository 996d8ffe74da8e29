/** The parts that an element can show, and the elements that they are made of. */
import { CuspMask } from "./mask-view.js";
import { CuspChart } from "./profile-chart.js";
import { CuspQuality } from "./quality.js";
import { CuspSettings } from "./settings-form.js";

/** What `panels` may name, in the order in which they stand. */
export const PANELS = ["open", "model", "settings", "plan", "view", "profile", "quality", "layers"] as const;

export type Panel = (typeof PANELS)[number];

/** Those that a list names, separated by blanks; all if it is empty. */
export function panelsOf(list: string | null): ReadonlySet<Panel> {
  const named = new Set(list?.trim().split(/\s+/) ?? []);
  const known = PANELS.filter((panel) => named.has(panel));
  return new Set(known.length === 0 ? PANELS : known);
}

const PARTS = {
  "cusp-settings": CuspSettings,
  "cusp-chart": CuspChart,
  "cusp-mask": CuspMask,
  "cusp-quality": CuspQuality,
} as const;

/** Makes the parts known to the browser, once, and not before an element is made. */
export function definePanels(): void {
  for (const [name, part] of Object.entries(PARTS)) {
    if (customElements.get(name) === undefined) customElements.define(name, part);
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-settings": CuspSettings;
    "cusp-chart": CuspChart;
    "cusp-mask": CuspMask;
    "cusp-quality": CuspQuality;
  }
}
