/** A page with only the view, or its panel with a plot next to it, controlled by tests through `window.harness`. */
import type { Model, Slicer } from "../../src/api/index.js";
import { CuspModel } from "../../src/element/panels/model-view.js";
import { languageOf } from "../../src/texts/index.js";
import { CuspView } from "../../src/view/cusp-view.js";
import { ball, box, cone } from "../../src/view/fixtures.js";

export interface Heard {
  readonly type: string;
  readonly detail: unknown;
}

const TYPES = ["cusp-rotate", "cusp-height", "cusp-layer", "cusp-frame", "cusp-select", "cusp-view-error"];

const heard: Heard[] = [];
customElements.define("cusp-view", CuspView);
const view = document.createElement("cusp-view");
for (const type of TYPES) {
  view.addEventListener(type, (event) => heard.push({ type, detail: (event as CustomEvent<unknown>).detail }));
}

customElements.define("cusp-model", CuspModel);
const panel = document.createElement("cusp-model");
/** Stands for a chart's plot. */
const plot = document.createElement("div");
plot.className = "plot";

interface PanelOptions {
  readonly positions: Float32Array;
  readonly z_mm: readonly number[];
  readonly locale?: string;
  /** True if there is a chart. */
  readonly hasPlot?: boolean;
  readonly style?: Partial<CSSStyleDeclaration>;
}

const harness = {
  view,
  panel,
  plot,
  /** The panel's view, once it has been fetched. */
  get inner(): CuspView | null {
    return panel.shadowRoot?.querySelector("cusp-view") ?? null;
  },
  /** Shows the panel in a frame sized by `style`, with a plot at its side. */
  async showPanel({ positions, z_mm, locale = "en", hasPlot = false, style = {} }: PanelOptions): Promise<void> {
    const thickness_mm = z_mm.slice(1).map((z, layer) => z - (z_mm[layer] ?? 0));
    const limits = [Math.min(...thickness_mm), Math.max(...thickness_mm)] as const;
    const profile = new Float32Array(0);
    Object.assign(panel, {
      // Only the fields that the panel uses.
      model: { info: { size_mm: [20, 20, 20] } } as unknown as Model,
      slicer: { positions: () => Promise.resolve(positions), preview: () => Promise.resolve({}) } as unknown as Slicer,
      shown: { metric: "cusp", profile, bin_mm: 0.002, z_mm, thickness_mm, limits, layers: thickness_mm.length, print_time_s: 0 },
      language: languageOf(locale),
    });
    const frame = document.createElement("div");
    frame.className = "frame";
    const card = document.createElement("div");
    card.className = "card";
    card.append(panel);
    frame.append(card);
    if (hasPlot) frame.append(plot);
    Object.assign(frame.style, style);
    const main = document.createElement("main");
    const heading = document.createElement("h1");
    heading.textContent = "The panel";
    main.append(frame, heading);
    document.body.replaceChildren(main);
    if (hasPlot) panel.plot = { over: plot, heights_mm: [0, z_mm.at(-1) ?? 0] };
    while (harness.inner === null || harness.inner.positions === null) await new Promise(requestAnimationFrame);
    await harness.drawn();
    await harness.drawn();
  },
  heard,
  solids: { ball, box, cone },
  /** Sets properties and waits until they are drawn. */
  async set(properties: Partial<CuspView>): Promise<void> {
    Object.assign(view, properties);
    await view.updateComplete;
    await harness.drawn();
  },
  /** Waits for two frames: the requested one, and the one after it. */
  async drawn(): Promise<void> {
    for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
  },
  show(): void {
    document.querySelector("main")?.append(view);
  },
};

export type Harness = typeof harness;

Object.assign(window, { harness });
