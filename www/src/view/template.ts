/** The markup around the view's canvas: its container, texts, colour scales and progress bar. */
import { html, nothing, type TemplateResult } from "lit";
import type { CuspView } from "./cusp-view.js";
import { heatLegend, legend } from "./legend/legend.js";

type Properties = Pick<
  CuspView,
  "texts" | "broken" | "tool" | "positions" | "thickness_mm" | "layer" | "limits" | "look" | "palette" | "showsLegend" | "aligned" | "building"
>;

/** Facts about the scene; defaults until it exists. */
export interface Known {
  readonly size_mm: readonly [number, number, number];
  readonly step_mm: number;
  /** Describes the selected layer; empty if there is none. */
  readonly layerWords: string;
  keyed(event: KeyboardEvent): void;
}

export function template(view: Properties, { size_mm, step_mm, layerWords, keyed }: Known): TemplateResult {
  const { texts, building } = view;
  if (view.broken) return html`<p class="unavailable">${texts.unavailable}</p>`;
  const layers = view.thickness_mm.length;
  return html`
    <div
      class="scene"
      part="scene"
      data-tool=${view.tool}
      tabindex="0"
      role="application"
      aria-roledescription=${texts.kind}
      aria-label=${texts.name}
      aria-describedby="state keys"
      @keydown=${keyed}
    >
      <div class="cross"></div>
    </div>
    <p class="visually-hidden" id="state">
      ${view.positions === null ? texts.empty : texts.state(size_mm, layers)} ${layerWords}
    </p>
    <p class="visually-hidden" id="keys">${texts.keys[view.tool]}</p>
    <span class="label" part="label" hidden>${layerWords}</span>
    ${scale(view)}
    ${view.positions === null || view.aligned ? nothing : html`<span class="grid">${texts.grid(step_mm)}</span>`}
    ${building === null
      ? nothing
      : html`<div class="building">
          ${texts.building(building)}
          <progress aria-label=${texts.building(building)} max="1" value=${building}></progress>
        </div>`}
    <span class="probe ink"></span><span class="probe accent"></span><span class="probe bad"></span>
  `;
}

/** The colour scale of the current look, if it has one. */
function scale({ texts, positions, thickness_mm, layer, limits, look, palette, showsLegend }: Properties): TemplateResult | typeof nothing {
  if (look === "weights") return positions === null ? nothing : heatLegend(texts);
  if (look !== "thickness" || !showsLegend || thickness_mm.length === 0) return nothing;
  const marked_mm = (layer === null ? undefined : thickness_mm[layer]) ?? null;
  return legend({ palette, limits, marked_mm, texts });
}
