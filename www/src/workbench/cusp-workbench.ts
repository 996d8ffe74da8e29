/**
 * `<cusp-workbench>`: the page's own element, with a whole slicer on one screen. It has the properties, events and gestures of
 * `<cusp-slicer>`, and another layout of the same panels.
 */
import type { TemplateResult } from "lit";
import { define } from "../element/define.js";
import type { Facts } from "../element/facts.js";
import type { PlotPlace } from "../element/panels/profile-chart.js";
import { modelStyles } from "../element/panels/model-card.js";
import { summaryStyles } from "../element/panels/summary.js";
import { problemStyles } from "../element/parts/problem-box.js";
import { partStyles } from "../element/parts/part.js";
import { progressStyles } from "../element/parts/progress.js";
import { SlicerElement } from "../element/slicer-element.js";
import { isPreSupported } from "../element/state/prepared.js";
import { copiesStyles } from "../element/styles/copies-styles.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { CuspLayerSlider } from "./layer-slider.js";
import { isOf, oneThickness, type Replaced } from "./one-thickness.js";
import { WIDE_PX, type AnswerPanel, type Sheet, type Step } from "./places.js";
import { workbenchStyles } from "./styles.js";
import { template } from "./template.js";

export class CuspWorkbench extends SlicerElement {
  static override styles = [theme, shared, modelStyles, summaryStyles, progressStyles, problemStyles, partStyles, copiesStyles, workbenchStyles];

  #isWide = true;
  /** Starts at the last step: a plan is made at once, and many users need only its file. */
  #step: Step = "slice";
  #answer: AnswerPanel = "quality";
  #sheet: Sheet | null = null;
  #plot: PlotPlace | null = null;
  #saved: string | null = null;
  /** The last plan that gave way to uniform layers. */
  #replaced: Replaced | null = null;
  readonly #resized = new ResizeObserver(() => {
    const isWide = this.clientWidth >= WIDE_PX;
    if (isWide !== this.#isWide) this.#set(() => (this.#isWide = isWide));
  });

  constructor() {
    super();
    define("cusp-layer-slider", CuspLayerSlider);
    this.session.checks.isWatching = true;
    this.addEventListener("cusp-export", ({ detail }) => this.#set(() => (this.#saved = detail.name)));
    this.addEventListener("cusp-plan", () => {
      this.#saved = null;
      const { settings } = this.session;
      // Once for a printer: after an undo, adaptive layers stay.
      if (this.#replaced !== null && isOf(this.#replaced, settings)) return;
      const found = oneThickness(this.session);
      if (found === null) return;
      this.#replaced = found.replaced;
      this.session.change(found.change);
    });
    this.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      if (!this.#isWide && this.#sheet !== null) this.#open(null);
      else this.session.checks.choose(null);
    });
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#isWide = this.clientWidth >= WIDE_PX;
    this.#resized.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#resized.disconnect();
  }

  /** Also dismisses the note on a saved file. */
  override cancel(): void {
    super.cancel();
    this.#set(() => (this.#saved = null));
  }

  protected override readonly opensProjects = true;

  protected override layout(facts: Facts): TemplateResult {
    return template(facts, {
      isWide: this.#isWide,
      step: this.#step,
      answer: this.#answer,
      sheet: this.#sheet,
      plot: this.#plot,
      replaced: this.#replaced,
      go: (step, from) => void this.#go(step, from),
      answers: (name) => this.#set(() => (this.#answer = name)),
      open: (sheet) => this.#open(sheet),
      placed: (plot) => this.#set(() => (this.#plot = plot)),
      prepare: () => void this.#prepare(),
      saved: this.#saved,
      dismiss: () => this.#set(() => (this.#saved = null)),
    });
  }

  /** Shows the search for a direction, then the check of the prepared model. One with supports in its file is prepared already. */
  async #prepare(): Promise<void> {
    const show = (step: Step): void => {
      this.#set(() => (this.#step = step));
      if (!this.#isWide) this.#open(step);
    };
    const { settings, result } = this.session;
    if (isPreSupported(settings, result)) return show("check");
    show("turn");
    if (await this.session.prepare()) show("check");
  }

  async #go(step: Step, from: "foot" | "row"): Promise<void> {
    // In the row of a narrow screen, the button of the open sheet closes it.
    const isClosing = from === "row" && step === this.#sheet;
    this.#set(() => (this.#step = step));
    if (!this.#isWide) this.#open(isClosing ? null : step);
    await this.updateComplete;
    const title = this.renderRoot.querySelector<HTMLElement>("#step-title");
    this.renderRoot.querySelector("[aria-labelledby=step-title]")?.scrollTo(0, 0);
    // After the button at a panel's foot, focus the next title, so that reading continues there.
    if (from === "foot") (title?.closest("button") ?? title)?.focus();
  }

  /** Opens a sheet of a narrow screen, or closes the open one. On closing, the focus returns to the button of the sheet. */
  #open(sheet: Sheet | null): void {
    const root = this.renderRoot as ShadowRoot;
    const { activeElement } = root;
    // If a press does not focus, as in Safari, there is no active element.
    if (sheet === null && (activeElement === null || activeElement.closest(".sheet") !== null)) {
      root.querySelector<HTMLElement>(".path [aria-current], .bar [aria-expanded=true]")?.focus();
    }
    this.#set(() => (this.#sheet = sheet));
  }

  #set(change: () => void): void {
    change();
    this.requestUpdate();
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-workbench": CuspWorkbench;
    "cusp-layer-slider": CuspLayerSlider;
  }
}
