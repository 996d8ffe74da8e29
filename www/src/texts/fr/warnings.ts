import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { EDGES, FACETS, FAULTS, HOLES, LAYERS, OBJECTS, OMITTED, PART_KINDS, PARTS, POINTS, UNITS } from "./nouns.js";

export const warnings = ({ count, counted, plural, mm, height, error, either }: Format): WarningSentences => ({
  "degenerate-facets": ({ facets }) => `${counted(facets, FACETS)} sans aire, ${plural(facets, OMITTED)}.`,
  "inside-out": () => "Le maillage était à l’envers et a été retourné.",
  "turned-facets": ({ facets }) => `${counted(facets, FACETS)} à l’envers : retournées.`,
  unorientable: ({ edges }) => `À ${counted(edges, EDGES)}, les facettes ne peuvent pas toutes être tournées du même côté : ce qui est dedans y est supposé. Regardez les masques.`,
  "open-mesh": ({ open_edges, holes }) =>
    `Le maillage n’est pas fermé : ${counted(open_edges, EDGES)} sans vis-à-vis, ${counted(holes, HOLES)}. Regardez les masques.`,
  "skipped-objects": ({ objects }) => `Du fichier sont omis : ${counted(objects, OBJECTS)}, des supports, des surfaces ou ce qui ne s’imprime pas.`,
  "subtracted-part": ({ name }) => `La pièce « ${name} » est soustraite.`,
  "skipped-part": ({ name, kind }) => `Laissé de côté : ${PART_KINDS[kind]} « ${name} ».`,
  "other-plates": ({ plate_number, plates }) => `Le plateau ${count(plate_number)} sur ${count(plates)} est lu.`,
  "odd-size": ({ size_mm, readings }) =>
    `Le fichier ne dit pas son unité, et en millimètres le modèle mesure ${mm(size_mm)} ; ` +
    readings.map(({ unit, size_mm }) => `en ${UNITS[unit]} ce serait ${mm(size_mm)} ; `).join("") +
    "donnez l’unité si c’en est une autre.",
  "unit-stated": ({ stated, given }) => `Le fichier est en ${UNITS[stated]}, comme il le dit, et non en ${UNITS[given]}.`,
  "nothing-hollowed": ({ wall_mm, cavity_mm }) =>
    `Le modèle reste plein : il n’est nulle part assez épais pour des parois de ${mm(wall_mm)} autour d’une cavité de ${mm(cavity_mm)}.`,
  "drain-astray": ({ drain_number }) =>
    `Le trou d’évacuation ${count(drain_number)} ne rencontre aucun vide et est omis. Placez-le là où le modèle est creux, ou tournez-le vers l’intérieur.`,
  undrained: ({ basins }) =>
    `${counted(basins, PARTS)} du vide : la résine y reste, car aucun trou n’en sort à niveau ou vers le bas. Placez-y des trous, ou tournez le modèle.`,
  "support-astray": ({ point_number }) => `Le support ${count(point_number)} n’est pas sur le modèle et a été omis ; placez-le sur la surface.`,
  unsupported: ({ points }) => `${counted(points, POINTS)} sans support, car aucun n’y parvient ; tournez le modèle ou choisissez des supports plus légers.`,
  "unclosed-rays": ({ unclosed, rays }) =>
    `${count(unclosed)} rayons sur ${count(rays)} traversent des trous du maillage qui ont été bouchés. Regardez les masques.`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `L’erreur atteint ${error(metric, max_error)}, plus que la tolérance de ${error(metric, tolerance)}.`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `Sur le maillage même l’erreur atteint ${error(metric, max_error)}, plus que la tolérance de ${error(metric, tolerance)} : les rayons manquent une partie de la surface.`,
  "sampled-sections": () => "La surface se croise ; les sections sont comptées le long des rayons.",
  "top-moved": ({ top_mm, height_mm }) =>
    `L’impression finit à ${mm(top_mm)}, car les couches ne font pas exactement ${mm(height_mm)}.`,
  "black-layers": ({ layers, from_mm }) =>
    `${counted(layers, LAYERS)} du plan sans pixel éclairé, à partir de ${height(from_mm)} : des parties flottent en l’air ou sont plus fines qu’un pixel. Regardez-y les masques.`,
  "one-thickness": ({ taker, best }) =>
    `${taker} n’admet qu’une épaisseur pour toutes les couches, et ce plan en a plusieurs ; ` +
    (best === null ? "choisissez des couches uniformes." : `${count(best.layers)} couches uniformes de ${mm(best.layer_mm)} respectent la tolérance.`),
  "untried-thicknesses": ({ model }) =>
    `Personne n’a dit si l’imprimante ${model} imprime des couches d’épaisseurs différentes ; imprimez les tours de test, ou choisissez des couches uniformes.`,
  "untried-slicer": ({ slicers }) =>
    `Personne n’a dit si ${either(slicers)} imprime les couches d’un tel fichier comme prévu ; avant d’imprimer, comparez-y le nombre et les hauteurs des couches dans l’aperçu.`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `Le CPU a fait le travail du GPU : le maillage demande un tampon de ${count(needed_bytes)} octets, et le GPU en offre ${count(limit_bytes)}.`,
  "gpu-failed": ({ fault, system }) =>
    `Le CPU a fait le travail du GPU, qui a échoué : ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
});
