/** The markup around the view's canvas: its container, texts, colour scales and progress bar. */
import { html, nothing, type TemplateResult } from "lit";
import type { CuspView } from "./cusp-view.js";
import { distanceLegend, heatLegend, legend } from "./legend/legend.js";
import { wallLegend } from "./legend/wall-legend.js";

type Properties = Pick<
  CuspView,
  "texts" | "broken" | "lost" | "tool" | "positions" | "thickness_mm" | "layer" | "limits" | "look" | "showsLegend" | "aligned" | "isBeside" | "building" | "measuring" | "greatest_mm" | "probing" | "walls" | "wall_mm"
>;

/** State of the scene; defaults until it exists. */
export interface Known {
  readonly size_mm: readonly [number, number, number];
  readonly step_mm: number;
  /** Describes the selected layer; empty if there is none. */
  readonly layerWords: string;
  keyed(event: KeyboardEvent): void;
  /** Requests another WebGL context. */
  again(): void;
}

export function template(view: Properties, { size_mm, step_mm, layerWords, keyed, again }: Known): TemplateResult {
  const { texts } = view;
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
    ${view.positions === null || isAligned(view) ? nothing : html`<span class="grid">${texts.grid(step_mm)}</span>`}
    ${working(view)}
    ${view.lost
      ? html`<div class="lost" role="alert">
          <p>${texts.lost}</p>
          <button @click=${again}>${texts.again}</button>
        </div>`
      : nothing}
    <span class="probe ink"></span><span class="probe accent"></span><span class="probe bad"></span>
  `;
}

/** Returns true if the view's heights are aligned with a chart, or would be with one. */
const isAligned = ({ aligned, isBeside }: Properties): boolean => aligned && isBeside !== false;

/** Progress of the current work, if any. */
function working({ texts, building, measuring, probing }: Properties): TemplateResult | typeof nothing {
  const part = building ?? measuring ?? probing;
  if (part === null) return nothing;
  const words = building !== null ? texts.building(part) : measuring !== null ? texts.measuring(part) : texts.probing(part);
  return html`<div class="building">
    ${words}
    <progress aria-label=${words} max="1" value=${part}></progress>
  </div>`;
}

/** Colour scale of the current look, if it has one. */
function scale(view: Properties): TemplateResult | typeof nothing {
  const { texts, positions, thickness_mm, layer, limits, look, isBeside, greatest_mm } = view;
  // A neighbouring chart has its own scale.
  const showsLegend = view.showsLegend && !(isAligned(view) && isBeside === true);
  if (look === "weights") return positions === null ? nothing : heatLegend(texts);
  if (look === "distance") return greatest_mm === null ? nothing : distanceLegend(greatest_mm, texts);
  if (look === "walls") return view.walls === null ? nothing : wallLegend(view.wall_mm, texts);
  if (look !== "thickness" || !showsLegend || thickness_mm.length === 0) return nothing;
  const marked_mm = (layer === null ? undefined : thickness_mm[layer]) ?? null;
  return legend({ limits, marked_mm, texts });
}
