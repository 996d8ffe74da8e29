/** What is known of the model that is open. */
import { html, nothing, type TemplateResult } from "lit";
import * as format from "../texts/format.js";
import { sentence } from "./problem.js";
import type { Model, Result } from "./session.js";

export function modelCard(
  { name, info }: Model,
  result: Result | null,
  picked: (event: Event) => void,
  example: () => void,
): TemplateResult {
  const scale = result === null || info.size_mm[2] === 0 ? 1 : result.report.height_mm / info.size_mm[2];
  const scaled = Math.abs(scale - 1) > 1e-3;
  const size = info.size_mm.map((mm) => mm * scale) as [number, number, number];
  const warnings = [...info.warnings, ...(result?.report.warnings ?? [])];
  const said = new Set<string>();
  return html`<section class="card model" aria-label="The model">
    <h2 id="model-name" tabindex="-1">${name}</h2>
    <dl class="figures">
      <div>
        <dt>Size</dt>
        <dd title="width × depth × height">${format.dimensions(size)}</dd>
        ${scaled ? html`<dd class="quiet">scaled from ${format.dimensions(info.size_mm)}</dd>` : nothing}
      </div>
      <div>
        <dt>Facets</dt>
        <dd>${format.count(info.facets)}</dd>
      </div>
      <div>
        <dt>Surface</dt>
        <dd>${info.closed ? "Watertight" : "Not watertight"}</dd>
      </div>
    </dl>
    ${warnings
      .filter(({ message }) => !said.has(message) && said.add(message))
      .map(({ message }) => html`<p class="warning">${sentence(message)}</p>`)}
    <div class="open-other">
      <label class="button small">
        <input class="hidden" type="file" accept=".stl,model/stl" @change=${picked} />Open another
      </label>
      <button class="link quiet" @click=${example}>Example</button>
    </div>
  </section>`;
}
