/** Colour scale of wall thickness, from 0 to the end beyond which all walls look the same. */
import { css, html, type TemplateResult } from "lit";
import { elementWith, given } from "../properties.js";
import { ENGLISH, type ViewTexts } from "../texts.js";
import { wallScale } from "../walls/scale.js";
import { legendStyles, ticks } from "./legend.js";
import { gradient } from "./palette.js";

const across = (place: number): string => `${(100 * place).toFixed(2)}%`;

type Texts = Pick<ViewTexts, "walls" | "thin" | "wall">;

/** @param wall_mm thinner walls are marked */
export function wallLegend(wall_mm: number, texts: Texts): TemplateResult {
  const { least_mm, full_mm } = wallScale(wall_mm);
  return html`
    <div class="legend walls" part="legend">
      <span class="heading">${texts.walls}</span>
      <div class="scale" .style=${`background: ${gradient()}`}>
        <i class="thin" .style=${`width: ${across(least_mm / full_mm)}`}></i>
      </div>
      <div class="ticks">
        ${[0, ...ticks([0, full_mm])].map((mm) => html`<span .style=${`left: ${across(mm / full_mm)}`}>${texts.wall(mm)}</span>`)}
        <span .style=${"left: 100%"}>≥\u00a0${texts.wall(full_mm)}</span>
      </div>
      <div class="limit"><i class="thin"></i> ${texts.thin(least_mm)}</div>
    </div>
  `;
}

/** The stripes match those of the shader. */
export const wallLegendStyles = css`
  .thin {
    background: repeating-linear-gradient(-45deg, rgb(199 13 41) 0 5px, #fff 5px 7.5px);
  }
  .scale .thin {
    position: absolute;
    inset: 0 auto 0 0;
    border-radius: 3px 0 0 3px;
  }
  .limit {
    display: flex;
    align-items: center;
    gap: 0.375rem;
    margin-top: 0.125rem;
  }
  .limit .thin {
    flex: none;
    width: 1.25rem;
    height: 0.75rem;
    border-radius: 3px;
  }
  @media (forced-colors: active) {
    .thin {
      forced-color-adjust: none;
    }
  }
`;

/** `<cusp-wall-legend>`: the scale outside the view, where the view has no room for it. The view's code brings it along. */
export class CuspWallLegend extends elementWith({ wall_mm: given(0), texts: given<Texts>(ENGLISH) }) {
  static override styles = [
    legendStyles,
    wallLegendStyles,
    css`
      .legend {
        display: var(--cusp-findings-legend, none);
        position: static;
        width: auto;
        max-width: 20rem;
        margin-block: 0.5rem;
        background: none;
      }
    `,
  ];

  override render(): TemplateResult {
    return wallLegend(this.wall_mm, this.texts);
  }
}
