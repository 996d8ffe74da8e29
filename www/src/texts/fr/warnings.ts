import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { BODIES, CAVITIES, EDGES, FACETS, FAULTS, HOLES, LAYERS, OBJECTS, OMITTED, PARTS, PART_KINDS, POINTS, UNITS } from "./nouns.js";

export const warnings = ({ count, counted, plural, exact, mm, tick, height, volume, error, either }: Format): WarningSentences => ({
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
  "nothing-to-drain": () => "Le modèle n’a pas de cavité fermée, donc aucun trou de vidange n’a été fait. Évidez-le.",
  "drain-astray": ({ drain_number }) =>
    `Le trou d’évacuation ${count(drain_number)} ne rencontre aucun vide et est omis. Placez-le là où le modèle est creux, ou tournez-le vers l’intérieur.`,
  undrained: ({ basins }) =>
    `${counted(basins, PARTS)} du vide : la résine y reste, car aucun trou n’en sort à niveau ou vers le bas. Placez-y des trous, ou tournez le modèle.`,
  "closed-cavities": ({ cavities, volume_mm3, at_mm }) =>
    `${counted(cavities, CAVITIES)} du modèle sans issue, avec ${volume(volume_mm3)} de résine, la plus grande en ${at_mm.map(tick).join(" ; ")}. Percez-y des trous, ou remplissez-les.`,
  "support-astray": ({ point_number }) => `Le support ${count(point_number)} n’est pas sur le modèle et a été omis ; placez-le sur la surface.`,
  unsupported: ({ points }) => `${counted(points, POINTS)} sans support, car aucun n’y parvient ; tournez le modèle ou choisissez des supports plus légers.`,
  "unclosed-rays": ({ unclosed, rays }) =>
    `${count(unclosed)} rayons sur ${count(rays)} traversent des trous du maillage qui ont été bouchés. Regardez les masques.`,
  "missed-bodies": ({ bodies, at_mm }) =>
    `${counted(bodies, BODIES)} dans tous les masques, le plus grand en ${at_mm.map(tick).join(" ; ")} : plus étroit qu’un pixel, aucun rayon ne le rencontre. Épaississez-le, ou choisissez des pixels plus petits.`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `L’erreur atteint ${error(metric, max_error)}, plus que la tolérance de ${error(metric, tolerance)}.`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `Sur le maillage même l’erreur atteint ${error(metric, max_error)}, plus que la tolérance de ${error(metric, tolerance)} : les rayons manquent une partie de la surface.`,
  "sampled-sections": () => "La surface se croise ; les sections sont comptées le long des rayons.",
  "top-moved": ({ top_mm, height_mm }) =>
    `L’impression finit à ${mm(top_mm)}, car les couches ne font pas exactement ${mm(height_mm)}.`,
  "black-layers": ({ layers, from_mm }) =>
    `${counted(layers, LAYERS)} du plan sans pixel éclairé, à partir de ${height(from_mm)} : des parties flottent en l’air ou sont plus fines qu’un pixel. Regardez-y les masques.`,
  "erased-parts": ({ layers, from_mm, area_mm2 }) =>
    `La compensation efface des parties de ${counted(layers, LAYERS)}, à partir de ${height(from_mm)}, au plus ${tick(area_mm2)}\u00a0mm² dans une couche : elles ne sont pas plus épaisses que ce qu’elle enlève. Épaississez-les, ou fixez une largeur minimale qu’elle respecte.`,
  "one-thickness": ({ taker, best }) =>
    `${taker} n’admet qu’une épaisseur pour toutes les couches, et ce plan en a plusieurs ; ` +
    (best === null ? "choisissez des couches uniformes." : `${count(best.layers)} couches uniformes de ${mm(best.layer_mm)} respectent la tolérance.`),
  "extrapolated-exposures": ({ layers, thinnest_mm, thickest_mm }) =>
    `L’exposition de ${counted(layers, LAYERS)} est extrapolée, car les expositions ne sont mesurées que de ${exact(thinnest_mm)} à ${mm(thickest_mm)} ; mesurez aussi celles-ci, ou gardez les épaisseurs minimale et maximale des couches dans cet intervalle.`,
  "untried-thicknesses": ({ model }) =>
    `Personne n’a dit si l’imprimante ${model} imprime des couches d’épaisseurs différentes ; imprimez les tours de test, ou choisissez des couches uniformes.`,
  "untried-slicer": ({ slicers }) =>
    `Personne n’a dit si ${either(slicers)} imprime les couches d’un tel fichier comme prévu ; avant d’imprimer, comparez-y le nombre et les hauteurs des couches dans l’aperçu.`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `Le CPU a fait le travail du GPU : le maillage demande un tampon de ${count(needed_bytes)} octets, et le GPU en offre ${count(limit_bytes)}.`,
  "gpu-failed": ({ fault, system }) =>
    `Le CPU a fait le travail du GPU, qui a échoué : ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
});
