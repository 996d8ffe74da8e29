/** The texts of the 3-D view, in the element's language. */
import type { Language } from "../../texts/index.js";
import { viewingTexts } from "../../texts/viewing.js";
import type { ViewTexts } from "../../view/texts.js";

const MICROMETRES = 1000;

export function viewTexts(language: Language): ViewTexts {
  const { texts, format } = language;
  const words = viewingTexts(language);
  const micrometres = (mm: number): string => format.tick(Math.round(mm * MICROMETRES * 10) / 10);
  return {
    name: texts.view.title,
    kind: words.kind,
    keys: words.keys,
    state: (size_mm, layers) => format.dimensions(size_mm) + (layers > 0 ? `, ${words.layers({ count: layers })}` : ""),
    empty: words.empty,
    legend: words.legend,
    heat: words.heat,
    distance: words.distance,
    walls: words.walls,
    thin: (least_mm) => words.thin({ least: format.mm(least_mm) }),
    wall: (mm) => format.exact(Math.round(mm * 100) / 100),
    probing: (part) => words.probing({ part: format.percent(part) }),
    weight: (weight) => format.percent(weight),
    tick: micrometres,
    layer: (layer, z_mm, thickness_mm) =>
      words.layer({ layer: format.count(layer + 1), height: format.height(z_mm), thickness: `${micrometres(thickness_mm)}\u00a0µm` }),
    grid: (step_mm) => words.grid({ step: format.fine(step_mm) }),
    building: (part) => words.building({ part: format.percent(part) }),
    measuring: (part) => words.measuring({ part: format.percent(part) }),
    unavailable: words.unavailable,
    lost: words.lost,
    again: words.again,
  };
}
