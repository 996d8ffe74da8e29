/** The print-through of a resin by the test bridges: their print file, a table for their thicknesses, and the values that fit them. */
import { css, html, nothing, type TemplateResult } from "lit";
import { FACTS } from "../../api/facts.js";
import type { CureFit } from "../../api/wire.js";
import { bridgesTexts } from "../../texts/bridges.js";
import type { Language } from "../../texts/index.js";
import type { TowersState } from "./towers-offer.js";
import { typed } from "./typed.js";

export const bridgesStyles = css`
  .bridges table {
    border-spacing: 0.2rem;
    font-size: 0.85em;
    margin: 0.5rem 0;
    width: 100%;
  }
  .bridges caption,
  .bridges th {
    font-weight: normal;
    text-align: start;
    white-space: nowrap;
  }
  .bridges input {
    box-sizing: border-box;
    min-width: 0;
    padding-inline: 0.25rem;
    width: 100%;
  }
`;

export interface Bridges {
  /** Thicknesses as typed, those in front first. */
  bridges: readonly string[];
  cureFit: CureFit | null;
  towers: TowersState;
  language: Language;
}

/** @param change called with all thicknesses once one is typed */
export function bridgesTable({ bridges, cureFit, towers, language }: Bridges, save: () => void, change: (bridges: readonly string[]) => void): TemplateResult {
  const words = bridgesTexts(language);
  const { format } = language;
  const cell = (place: number, layers: number, layer_mm: number): TemplateResult => html`<td>
    <input
      inputmode="decimal"
      aria-label=${words.cell({ layers: format.count(layers), thickness: format.fine(layer_mm) })}
      .value=${typed(bridges[place] ?? "")}
      @change=${({ target }: Event) => change(bridges.with(place, (target as HTMLInputElement).value))}
    />
  </td>`;
  return html`<p class="hint">${words.hint}</p>
    <button class="small" type="button" ?disabled=${towers !== "ready"} @click=${save}>${words.download}</button>
    <table>
      <caption>${words.caption}</caption>
      <thead>
        <tr>
          <th scope="col">${words.layers}</th>
          ${FACTS.bridges_mm.map((layer_mm) => html`<th scope="col">${format.fine(layer_mm)}</th>`)}
        </tr>
      </thead>
      <tbody>
        ${FACTS.bridges.map((layers, row) => html`<tr>
          <th scope="row">${format.count(layers)}</th>
          ${FACTS.bridges_mm.map((layer_mm, column) => cell(column * FACTS.bridges.length + row, layers, layer_mm))}
        </tr>`)}
      </tbody>
    </table>
    <p class="hint" role="status">${cureFit === null ? nothing : fitted(cureFit, language)}</p>`;
}

function fitted({ residual_mm, penetration_within_mm, overcure_within_mm, retained_within }: CureFit, language: Language): string {
  const words = bridgesTexts(language);
  const { format } = language;
  const within = (values: readonly number[], digits: number): [string, string] => values.map((value) => format.tick(Number(value.toFixed(digits)))) as [string, string];
  const [overcureLeast, overcureMost] = within(overcure_within_mm, 3);
  const [penetrationLeast, penetrationMost] = within(penetration_within_mm, 3);
  const [retainedLeast, retainedMost] = within(retained_within, 2);
  const residual = format.fine(Number(residual_mm.toFixed(3)));
  return words.fitted({ residual, overcureLeast, overcureMost, penetrationLeast, penetrationMost, retainedLeast, retainedMost });
}
