import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { BODIES, CAVITIES, EDGES, FACETS, FAULTS, HOLES, LAYERS, OBJECTS, OMITTED, PARTS, PART_KINDS, POINTS, UNITS } from "./nouns.js";

export const warnings = ({ count, counted, plural, exact, mm, tick, height, volume, error, either }: Format): WarningSentences => ({
  "degenerate-facets": ({ facets }) => `${counted(facets, FACETS)} sin área, ${plural(facets, OMITTED)}.`,
  "inside-out": () => "La malla estaba del revés y se le dio la vuelta.",
  "turned-facets": ({ facets }) => `${counted(facets, FACETS)} del revés: se les dio la vuelta.`,
  unorientable: ({ edges }) => `En ${counted(edges, EDGES)} las facetas no pueden mirar todas hacia el mismo lado: lo que está dentro ahí es una suposición. Mire las máscaras.`,
  "open-mesh": ({ open_edges, holes }) =>
    `La malla no está cerrada: ${counted(open_edges, EDGES)} sin pareja, ${counted(holes, HOLES)}. Mire las máscaras.`,
  "skipped-objects": ({ objects }) => `Del archivo se omite: ${counted(objects, OBJECTS)}, que son soportes, superficies o no se imprimen.`,
  "subtracted-part": ({ name }) => `La parte «${name}» se resta.`,
  "skipped-part": ({ name, kind }) => `Se omite: ${PART_KINDS[kind]} «${name}».`,
  "other-plates": ({ plate_number, plates }) => `Se lee la placa ${count(plate_number)} de ${count(plates)}.`,
  "odd-size": ({ size_mm, readings }) =>
    `El archivo no dice su unidad, y en milímetros el modelo mide ${mm(size_mm)}; ` +
    readings.map(({ unit, size_mm }) => `en ${UNITS[unit]} serían ${mm(size_mm)}; `).join("") +
    "indique la unidad si es otra.",
  "unit-stated": ({ stated, given }) => `El archivo está en ${UNITS[stated]}, como dice, y no en ${UNITS[given]}.`,
  "nothing-hollowed": ({ wall_mm, cavity_mm }) =>
    `El modelo queda macizo: en ningún sitio es bastante grueso para paredes de ${mm(wall_mm)} alrededor de un hueco de ${mm(cavity_mm)}.`,
  "nothing-to-drain": () => "El modelo no tiene ninguna cavidad cerrada, así que no se hizo ningún agujero de drenaje. Vacíelo.",
  "drain-astray": ({ drain_number }) =>
    `El agujero de drenaje ${count(drain_number)} no llega al hueco y se omite. Póngalo donde el modelo sea hueco, o gírelo hacia dentro.`,
  undrained: ({ basins }) =>
    `${counted(basins, PARTS)} del hueco: allí queda resina, pues ningún agujero sale a nivel ni hacia abajo. Ponga agujeros allí, o gire el modelo.`,
  "closed-cavities": ({ cavities, volume_mm3, at_mm }) =>
    `${counted(cavities, CAVITIES)} del modelo sin salida, con ${volume(volume_mm3)} de resina, la mayor en ${at_mm.map(tick).join("; ")}. Haga agujeros hasta allí, o rellénelas.`,
  "support-astray": ({ point_number }) => `El soporte ${count(point_number)} no está sobre el modelo y se ha omitido; colóquelo en la superficie.`,
  unsupported: ({ points }) => `${counted(points, POINTS)} sin soporte, porque ninguno llega hasta allí; gire el modelo o elija soportes más ligeros.`,
  "unclosed-rays": ({ unclosed, rays }) =>
    `${count(unclosed)} de ${count(rays)} rayos atraviesan agujeros de la malla que se taparon. Mire las máscaras.`,
  "missed-bodies": ({ bodies, at_mm }) =>
    `${counted(bodies, BODIES)} en todas las máscaras, el mayor en ${at_mm.map(tick).join("; ")}: más estrecho que un píxel, ningún rayo lo alcanza. Hágalo más grueso, o elija píxeles menores.`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `El error llega a ${error(metric, max_error)}, más que la tolerancia de ${error(metric, tolerance)}.`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `En la propia malla el error llega a ${error(metric, max_error)}, más que la tolerancia de ${error(metric, tolerance)}: los rayos no ven una parte de la superficie.`,
  "sampled-sections": () => "La superficie se cruza consigo misma; las secciones se cuentan a lo largo de rayos.",
  "top-moved": ({ top_mm, height_mm }) =>
    `La impresión termina en ${mm(top_mm)}, porque las capas no suman exactamente ${mm(height_mm)}.`,
  "black-layers": ({ layers, from_mm }) =>
    `${counted(layers, LAYERS)} del plan sin ningún píxel iluminado, desde ${height(from_mm)}: hay partes en el aire o más finas que un píxel. Mire ahí las máscaras.`,
  "erased-parts": ({ layers, from_mm, area_mm2 }) =>
    `La compensación borra partes de ${counted(layers, LAYERS)}, desde ${height(from_mm)}, como mucho ${tick(area_mm2)}\u00a0mm² en una: no son más gruesas que lo que quita. Hágalas más gruesas, o fije una anchura mínima que respete.`,
  "one-thickness": ({ taker, best }) =>
    `${taker} admite un solo espesor para todas las capas, y este plan tiene varios; ` +
    (best === null ? "elija capas uniformes." : `${count(best.layers)} capas uniformes de ${mm(best.layer_mm)} cumplen la tolerancia.`),
  "extrapolated-exposures": ({ layers, thinnest_mm, thickest_mm }) =>
    `La exposición de ${counted(layers, LAYERS)} está extrapolada, pues solo hay exposiciones medidas de ${exact(thinnest_mm)} a ${mm(thickest_mm)}; mida también esas, o mantenga el espesor de capa mínimo y máximo en ese intervalo.`,
  "untried-thicknesses": ({ model }) =>
    `Nadie ha dicho si la ${model} imprime capas de distinto espesor; imprima las torres de prueba o elija capas uniformes.`,
  "untried-slicer": ({ slicers }) =>
    `Nadie ha dicho si ${either(slicers)} imprime las capas de un archivo así como está planeado; compare allí, en la vista previa, el número y las alturas de las capas antes de imprimir.`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `La CPU hizo el trabajo de la GPU: la malla necesita un búfer de ${count(needed_bytes)} bytes, y la GPU ofrece ${count(limit_bytes)}.`,
  "gpu-failed": ({ fault, system }) =>
    `La CPU hizo el trabajo de la GPU, que falló: ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
});
