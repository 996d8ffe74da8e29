/** A surface that faces down, as it cures without and with compensation for print-through. */
import { html, svg, type TemplateResult } from "lit";
import type { PrintThroughReport } from "../../api/wire.js";

/** Units of the drawing: width of an overhang, its thickness, and the longest excess below it. */
const [WIDTH, THICK, LONGEST] = [44, 14, 22];

/** @param label the picture in words */
export function undersidePicture({ before, after }: PrintThroughReport, label: string): TemplateResult {
  const scale = LONGEST / Math.max(before.mean_mm, after.mean_mm, Number.EPSILON);
  const overhang = (x: number, mm: number): TemplateResult => svg`<g transform="translate(${x} 2)">
    <path class="solid" d="M0 0h${WIDTH}v${THICK}h${-WIDTH / 2}v${LONGEST + 6}h${-WIDTH / 2}z" />
    <rect class="excess" x=${WIDTH / 2} y=${THICK} width=${WIDTH / 2} height=${mm * scale} />
  </g>`;
  return html`<svg class="underside" viewBox="0 0 ${2 * WIDTH + 20} ${THICK + LONGEST + 10}" role="img" aria-label=${label}>
    ${overhang(2, before.mean_mm)} ${svg`<path class="arrow" d="M${WIDTH + 5} ${THICK + 8}h8m-3 -3l3 3l-3 3" />`} ${overhang(WIDTH + 18, after.mean_mm)}
  </svg>`;
}
