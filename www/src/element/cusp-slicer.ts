/**
 * `<cusp-slicer>`: shows a model in its layers, a choice of quality, the print time and amount of resin, and offers the print file.
 *
 * Everything runs in the customer's browser. See docs/embed.md for attributes, events, colours and parts.
 */
import type { TemplateResult } from "lit";
import type { Facts } from "./facts.js";
import { modelStyles } from "./panels/model-card.js";
import { summaryStyles } from "./panels/summary.js";
import { problemStyles } from "./parts/problem-box.js";
import { partStyles } from "./parts/part.js";
import { progressStyles } from "./parts/progress.js";
import { SlicerElement } from "./slicer-element.js";
import { copiesStyles } from "./styles/copies-styles.js";
import { layoutStyles } from "./styles/layout.js";
import { shared } from "./styles/shared.js";
import { theme } from "./styles/theme.js";
import { template } from "./template.js";

export class CuspSlicer extends SlicerElement {
  static override styles = [theme, shared, modelStyles, summaryStyles, progressStyles, problemStyles, partStyles, copiesStyles, layoutStyles];

  protected override layout(facts: Facts): TemplateResult {
    return template(facts, this.clientWidth >= WIDE_PX);
  }
}

/** Minimum width for settings next to the results, and expanded. */
const WIDE_PX = 896;

declare global {
  interface HTMLElementTagNameMap {
    "cusp-slicer": CuspSlicer;
  }
}
