import type { UniformLayers } from "../../api/wire.js";
import type { Format } from "../format.js";
import { adviceOn, ended, FILE_KINDS, flatKind, STL_KEYWORDS, type ErrorSentences, type QuantityNouns, type StlNouns, type WorkWords } from "../sentences.js";
import { FACETS, FAULTS } from "./nouns.js";
import { readers } from "./readers.js";

const QUANTITIES: QuantityNouns = {
  pitch: "Le pas des pixels",
  bin: "La hauteur des intervalles",
  step: "Le pas du moteur",
  layer: "L’épaisseur de couche",
  "first-layer": "La première couche",
  "layer-min": "L’épaisseur de couche minimale",
  "layer-max": "L’épaisseur de couche maximale",
  tolerance: "La tolérance",
  "resin-layer": "L’épaisseur de couche de la résine",
  penetration: "La profondeur de pénétration",
  exposure: "L’exposition",
  "bottom-exposure": "L’exposition des premières couches",
  wait: "L’attente entre les couches",
  lift: "La hauteur de levée",
  "lift-speed": "La vitesse de levée",
  "return-speed": "La vitesse de retour",
  density: "La densité de la résine",
};

const WORK: WorkWords = {
  hits: ["L’échantillonnage du modèle", ", ou choisissez des pixels plus grands"],
  layers: ["La planification", ", ou choisissez des tranches plus grandes ou moins d’épaisseurs"],
  saliency: ["La recherche de ce qui ressort", ", passez-vous-en, ou prenez un modèle de moins de facettes"],
  all: ["Cela", ""],
};

const EXPECTED: StlNouns = {
  ...STL_KEYWORDS,
  "facet-or-endsolid": "`facet` ou `endsolid`",
  "normal-number": "un nombre de la normale",
  coordinate: "une coordonnée",
};

const inPlace = (best: UniformLayers | null | undefined, { count, mm }: Pick<Format, "count" | "mm">): string =>
  best ? `${count(best.layers)} couches uniformes de ${mm(best.layer_mm)}, qui respectent la tolérance` : "des couches uniformes";

export const errors = ({ count, counted, exact, mm, measure, error, either }: Format): ErrorSentences => ({
  ...readers({ count }),
  "file-empty": () => "Le fichier est vide ; exportez à nouveau le modèle.",
  "unknown-file-kind": () => "Ce n’est pas un modèle que Cusp lit ; exportez-le en STL, 3MF ou OBJ.",
  "no-plate": ({ plate_number, plates }) => `Il n’y a pas de plateau ${count(plate_number)} : le fichier en a ${count(plates)}.`,
  "other-file-kind": ({ kind }) =>
    flatKind(kind, { picture: "une image", document: "un document", drawing: "un dessin" }, (noun) => `C’est ${noun} (${FILE_KINDS[kind]}) ; Cusp ouvre les STL, 3MF, OBJ et fichiers d’impression.`) ??
    `C’est un fichier ${FILE_KINDS[kind]}, que Cusp ne lit pas ; ${adviceOn(kind, {
      model: "exportez le modèle en STL, 3MF ou OBJ",
      packed: "décompressez-le et ouvrez le modèle qu’il contient",
      page: "téléchargez le modèle lui-même ; l’adresse demande peut-être une connexion, ou mène à une page sur le modèle",
    })}.`,
  "stl-truncated": (detail) =>
    "line" in detail
      ? `Le STL est tronqué : il finit à la ligne ${count(detail.line)}, où ${EXPECTED[detail.expected]} devrait suivre.`
      : `Le STL est tronqué : son en-tête annonce ${counted(detail.declared_facets, FACETS)}, soit ${count(detail.expected_bytes)} octets, ` +
        `mais le fichier finit à l’octet ${count(detail.found_bytes)} ; copiez-le ou exportez-le à nouveau.`,
  "stl-wrong-facet-count": ({ declared_facets, found_facets }) =>
    `Le nombre de facettes est faux : l’en-tête en annonce ${count(declared_facets)} à l’octet 80, mais ${count(found_facets)} suivent ; exportez à nouveau le modèle.`,
  "stl-not-finite": (detail) =>
    "line" in detail
      ? `Ligne ${count(detail.line)} : \`${detail.text}\` n’est pas un nombre fini ; exportez à nouveau le modèle.`
      : `La coordonnée à l’octet ${count(detail.byte)} (facette ${count(detail.facet)}) n’est pas un nombre fini ; exportez à nouveau le modèle.`,
  "stl-syntax": ({ line, expected, found }) =>
    `Ligne ${count(line)} : ${EXPECTED[expected]} attendu, \`${found}\` trouvé ; exportez à nouveau le modèle.`,
  "stl-no-facets": () => "Le STL ne contient pas de facettes ; exportez à nouveau le modèle.",
  "mesh-no-area": ({ facets }) => `Aucune facette n’a d’aire (sur ${count(facets)}) ; exportez à nouveau le modèle.`,
  "mesh-zero-height": () => "Le modèle n’a pas de hauteur ; est-il plat, ou couché dans le plan z = constante ?",
  "mesh-overflow": () => "Le modèle est trop grand : à cette hauteur, il mesure plus d’un kilomètre ; choisissez une autre unité ou une autre hauteur.",
  "bad-height": ({ height_mm }) => `La hauteur doit être supérieure à 0, pas ${mm(height_mm)}.`,
  "bad-rotation": () => "La rotation doit être un quaternion x, y, z, w de longueur non nulle.",
  "bad-length": ({ quantity, value, unit, least, most }, metric) =>
    `${QUANTITIES[quantity]} doit se situer entre ${exact(least)} et ${measure(most, unit, metric)}, et non à ${measure(value, unit, metric)}.`,
  "bad-time": ({ quantity, value_s, most_s }) => `${QUANTITIES[quantity]} doit se situer entre 0 et ${measure(most_s, "s")}, et non à ${measure(value_s, "s")}.`,
  "bad-exposures": ({ previous_mm, next_mm }) =>
    `Les expositions mesurées doivent être dans l’ordre des épaisseurs, chacune plus épaisse que la précédente, mais ${mm(next_mm)} suit ${mm(previous_mm)}.`,
  "bad-growth": ({ least_mm, most_mm, value_mm }) =>
    `La croissance d’une impression doit être comprise entre ${exact(least_mm)} et ${mm(most_mm)}, et non ${mm(value_mm)}.`,
  "bad-options": ({ system }) => `Les options sont illisibles : ${ended(system)}`,
  "unknown-printer": ({ printer, similar, known }) =>
    `Aucune imprimante ${printer} parmi les ${count(known)} connues${similar.length === 0 ? "" : ` ; s’en approchent ${similar.join(", ")}`}.`,
  "bad-printer": ({ printer, field }) => `L’imprimante ${printer} ne peut pas avoir cette valeur de ${field} ; corrigez sa description.`,
  "printer-not-json": ({ system }) => `Ce fichier ne décrit pas une imprimante en JSON : ${ended(system)}`,
  "printer-too-long": ({ bytes, most_bytes }) => `La description d’une imprimante compte au plus ${count(most_bytes)} octets et ce fichier en compte ${count(bytes)} ; choisissez un autre fichier.`,
  "pixels-without-pitch": () => "Les pixels et leur pas en x et y vont ensemble ; donnez les deux, ou un seul pas pour x et y.",
  "bad-antialias": ({ antialias, known }) => `L’anticrénelage a les niveaux ${known.join(", ")}, pas ${exact(antialias)}.`,
  "bad-size": ({ option, value_mm, least_mm, most_mm }) => `${option} doit être compris entre ${mm(least_mm)} et ${mm(most_mm)}, et non ${mm(value_mm)}.`,
  "bad-weight-min": ({ weight_min }) => `Le poids minimal doit être entre 0 et 1, pas ${exact(weight_min)}.`,
  "bad-directions": ({ directions, most }) => `Une recherche examine de 1 à ${count(most)} directions, pas ${count(directions)}.`,
  "bad-limit": ({ limit, value, least, most }) => `${limit} doit être entre ${exact(least)} et ${exact(most)}, pas ${exact(value)}.`,
  "bad-alpha": ({ alpha }) => `Alpha doit être entre 0 et 1, pas ${exact(alpha)}.`,
  "bad-search-limit": ({ limit, value }) => `${limit} doit être 0 ou plus, pas ${exact(value)}.`,
  "search-task": ({ task }) => `Le résultat de la tâche ${exact(task)} ne correspond à aucune tâche en cours ; remettez chaque résultat une seule fois.`,
  "search-candidate": ({ place }) => `Le candidat ${exact(place)} n’a pas été mesuré pour sa direction.`,
  "several-targets": () => "Donnez une tolérance, le plus grand nombre de couches ou la plus longue durée, et une seule des trois.",
  "contradictory-options": ({ option, other }) => `${option} et ${other} s’excluent. Retirez l’un des deux.`,
  "printer-layers": ({ model, printer_min_mm, printer_max_mm, layer_min_mm, layer_max_mm }) =>
    `La ${model} imprime des couches de ${exact(printer_min_mm)} à ${mm(printer_max_mm)}, pas de ${exact(layer_min_mm)} à ${mm(layer_max_mm)} ; ` +
    "restez dans ces limites, ou choisissez une autre imprimante.",
  "printer-step": ({ model, printer_step_mm, step_mm }) =>
    `La ${model} avance par pas de ${mm(printer_step_mm)}, et ${mm(step_mm)} n’en est pas un nombre entier ; prenez un multiple de ${mm(printer_step_mm)}.`,
  "resin-printer": ({ format, model }) =>
    `Les fichiers ${format} sont pour imprimantes à filament, et la ${model} imprime de la résine ; retirez l’imprimante, ou choisissez un format qu’elle lit.`,
  "nozzle-without-filament": ({ formats }) =>
    `Une buse ne va qu’avec les formats pour imprimantes à filament : ${formats.join(", ")} ; choisissez l’un d’eux, ou retirez la buse.`,
  "bad-nozzle": ({ nozzle_mm, least_mm, most_mm }) => `La buse doit mesurer de ${exact(least_mm)} à ${mm(most_mm)}, pas ${mm(nozzle_mm)}.`,
  "nozzle-layers": ({ slicers, nozzle_mm, nozzle_min_mm, nozzle_max_mm, layer_min_mm, layer_max_mm }) =>
    `Par une buse de ${mm(nozzle_mm)}, ${either(slicers)} imprime des couches de ${exact(nozzle_min_mm)} à ${mm(nozzle_max_mm)}, ` +
    `pas de ${exact(layer_min_mm)} à ${mm(layer_max_mm)} ; restez dans ces limites, ou indiquez une autre buse.`,
  "grid-bad-size": ({ width, height, max_side, max_pixels }) =>
    `Un masque de ${count(width)} × ${count(height)} pixels n’est pas possible : il peut y en avoir de 1 à ${count(max_side)} par côté, et ${count(max_pixels)} en tout.`,
  "grid-too-fine": ({ width, height, max_side, max_pixels }) =>
    `L’anticrénelage demande ${count(width)} × ${count(height)} rayons, et il peut y en avoir ${count(max_side)} par côté, et ${count(max_pixels)} en tout ; choisissez un niveau plus bas.`,
  "model-too-large": ({ model_mm_x, model_mm_y, grid_mm_x, grid_mm_y, fitting_scale }) =>
    `Le modèle mesure ${exact(model_mm_x)} × ${mm(model_mm_y)}, mais la grille ne couvre que ${exact(grid_mm_x)} × ${mm(grid_mm_y)} ; une échelle de ${exact(fitting_scale)} convient.`,
  "model-too-high": ({ model_mm_z, printer_mm_z, fitting_scale }) =>
    `Le modèle a ${mm(model_mm_z)} de haut, mais l’imprimante n’imprime que ${mm(printer_mm_z)} ; une échelle de ${exact(fitting_scale)} convient.`,
  "plate-empty": () => "Il n’y a pas de modèle sur le plateau ; ajoutez-en un.",
  "plate-without-size": () => "La taille du plateau n’est pas connue ; choisissez une imprimante, ou indiquez les pixels et leur pas.",
  "bad-spacing": ({ spacing_mm }) => `L’écart doit être de 0 à 100 mm, et non ${mm(spacing_mm)}.`,
  "bad-turn": ({ turn_deg }) => `Les modèles tournent par pas de 0, 15, 30, 45, 60, 90, 120 ou 180°, et non ${exact(turn_deg)}°.`,
  "plate-too-small": ({ model_number, size_mm, plate_mm }) =>
    `Le modèle ${count(model_number)} mesure ${exact(size_mm[0])} × ${mm(size_mm[1])}, et le plateau ${exact(plate_mm[0])} × ${mm(plate_mm[1])} ; changez son échelle, ou choisissez une autre orientation ou une autre imprimante.`,
  "too-many-copies": ({ copies, most_copies }) =>
    `${count(copies)} copies sont trop pour un travail, qui en a ${count(most_copies)} au plus ; faites-en plusieurs travaux.`,
  "plate-other-copies": ({ model_number, copies, places }) =>
    `Le modèle ${count(model_number)} doit être imprimé ${count(copies)} fois et a ${count(places)} places ; corrigez l’un des deux, ou disposez le plateau.`,
  "plate-gap": ({ plate_number }) => `Rien n’est sur le plateau ${count(plate_number)}, mais sur un suivant ; numérotez les plateaux sans lacune.`,
  "plate-outside": ({ model_number, copy_number, plate_number }) =>
    `La copie ${count(copy_number)} du modèle ${count(model_number)} dépasse du plateau ${count(plate_number)} ; déplacez-la, ou disposez le plateau.`,
  "plate-collision": ({ model_numbers, copy_numbers, plate_number }) =>
    `La copie ${count(copy_numbers[0])} du modèle ${count(model_numbers[0])} et la copie ${count(copy_numbers[1])} du modèle ${count(model_numbers[1])} se chevauchent sur le plateau ${count(plate_number)} ; déplacez-en une, ou disposez le plateau.`,
  "plate-no-model": ({ model_number, models }) => `Il n’y a pas de modèle ${count(model_number)} ; le plateau en a ${count(models)}.`,
  "no-such-plate": ({ plate_number, plates }) => `Il n’y a pas de plateau ${count(plate_number)} ; il y en a ${count(plates)}.`,
  "too-many-bins": ({ height_mm, bin_mm }) =>
    `${mm(height_mm)} en intervalles de ${mm(bin_mm)}, c’est trop ; choisissez un intervalle plus grand.`,
  "not-whole-bins": ({ quantity, length_mm, bin_mm }) =>
    `${QUANTITIES[quantity]} de ${mm(length_mm)} n’est pas un nombre entier d’intervalles de ${mm(bin_mm)} ; choisissez un intervalle qui le divise.`,
  "not-whole-steps": ({ quantity, length_mm, step_mm }) =>
    `${QUANTITIES[quantity]} de ${mm(length_mm)} n’est pas un nombre entier de pas de ${mm(step_mm)} ; choisissez un multiple de ${mm(step_mm)}.`,
  "layer-range-upside-down": ({ layer_min_mm, layer_max_mm }) =>
    `L’épaisseur de couche minimale de ${mm(layer_min_mm)} dépasse la maximale de ${mm(layer_max_mm)} ; réduisez l’une ou augmentez l’autre.`,
  "layer-range-empty": ({ layer_min_mm, layer_max_mm, step_mm }) =>
    `Aucun nombre entier de pas de ${mm(step_mm)} n’est entre les épaisseurs ${exact(layer_min_mm)} et ${mm(layer_max_mm)} ; ` +
    "élargissez l’intervalle ou choisissez un pas plus petit.",
  "layer-too-thick": ({ layer_mm, height_mm }) =>
    `Des couches de ${mm(layer_mm)} sont trop épaisses pour un modèle de ${mm(height_mm)} de haut.`,
  "layers-do-not-fit": ({ from_mm, to_mm, layer_min_mm, layer_max_mm }) =>
    `Des couches de ${exact(layer_min_mm)} à ${mm(layer_max_mm)} ne font pas la hauteur de ${exact(from_mm)} à ${mm(to_mm)} ; ` +
    "élargissez l’intervalle d’épaisseurs ou déplacez les plans.",
  "thicknesses-do-not-fit": ({ from_mm, to_mm, model_number, tolerance, thicknesses_mm, least_tolerance }) =>
    `Des couches de ${thicknesses_mm.map(mm).join(", ")} ne mènent pas de z = ${exact(from_mm)} à ${mm(to_mm)} dans la tolérance de ${exact(tolerance)}${model_number === null ? "" : ` sur le modèle ${count(model_number)}`} ; ` +
    (least_tolerance === null
      ? "ajoutez une épaisseur ou déplacez les plans."
      : `portez la tolérance à ${exact(least_tolerance)} ou ajoutez une épaisseur.`),
  "too-few-thicknesses": ({ thicknesses, enough }) =>
    `Aucun plan dans la tolérance n’a au plus ${count(thicknesses)} épaisseurs de couche ; permettez-en ${count(enough)}, ou augmentez la tolérance.`,
  "not-gradual": ({ change_mm, least_change_mm }) =>
    `Aucun plan dans la tolérance ne change l’épaisseur d’au plus ${mm(change_mm)} d’une couche à l’autre ; permettez des changements de ${mm(least_change_mm)}, ou augmentez la tolérance.`,
  "bad-range": ({ from_mm, to_mm }) =>
    `L’intervalle de hauteur de ${exact(from_mm)} à ${mm(to_mm)} est vide ou en chevauche un autre ; donnez des intervalles croissants et séparés.`,
  "bad-plane": ({ z_mm, height_mm }) => `Il ne peut y avoir de plan à ${mm(z_mm)} dans un modèle de ${mm(height_mm)} de haut.`,
  infeasible: ({ from_mm, to_mm, model_number, tolerance, layer_min_mm }, metric) =>
    `Aucun plan ne garde l’erreur de chaque couche${model_number === null ? "" : ` sur le modèle ${count(model_number)}`} sous ${error(metric, tolerance)} : de z = ${exact(from_mm)} à ${mm(to_mm)}, même une couche de ${mm(layer_min_mm)} la dépasse.`,
  "out-of-reach": (detail) =>
    "layers" in detail
      ? `Aucun plan n’a au plus ${count(detail.layers)} couches ; il en faut au moins ${count(detail.least_layers)}.`
      : `Aucun plan n’imprime en au plus ${measure(detail.time_s, "s")} ; il faut au moins ${measure(detail.least_time_s, "s")}.`,
  "no-plan": () => "Il n’y a pas encore de plan ; faites-en un d’abord.",
  "memory-bound": ({ needed_bytes, allowed_bytes }) =>
    `Cela demande environ ${count(needed_bytes)} octets de mémoire, et ${count(allowed_bytes)} sont permis ; permettez-en plus, ou choisissez des pixels plus grands.`,
  "time-bound": ({ work, needed_s, allowed_s }) => {
    const [subject, way] = WORK[work];
    return `${subject} prend environ ${count(needed_s)}\u00a0s de processeur, et ${count(allowed_s)} sont permises ; permettez-en plus${way}.`;
  },
  "no-layer": ({ layer, layers }) => `Il n’y a pas de couche ${count(layer)} ; le plan en a ${count(layers)}, à partir de 0.`,
  "no-hits": ({ pitch_mm }) =>
    `Aucun pixel de ${mm(pitch_mm)} ne touche le modèle, trop petit ou trop fin pour eux ; choisissez des pixels plus petits.`,
  "too-many-facets": ({ facets, most }) => `${count(facets)} facettes, c’est trop ; ${count(most)} au plus peuvent être tranchées.`,
  "out-of-memory": ({ hits, needed_bytes }) =>
    `Le modèle demande ${count(needed_bytes)} octets pour ${count(hits)} points de surface à cette résolution, plus qu’il n’y en a ; choisissez moins de rayons.`,
  "no-gpu": ({ system }) => `Pas de GPU utilisable : ${ended(system)}`,
  "gpu-emulated": ({ adapter }) => `Pas de GPU utilisable : ${adapter} est émulé par logiciel.`,
  "gpu-too-small": ({ facets, needed_bytes, limit_bytes }) =>
    `${counted(facets, FACETS)} demandent un tampon de GPU de ${count(needed_bytes)} octets, et ce GPU en offre ${count(limit_bytes)} ; utilisez le CPU.`,
  "gpu-failed": ({ fault, system }) => `Le GPU a échoué : ${FAULTS[fault]}${system === null ? "" : ` (${system})`}.`,
  "all-black": () =>
    "Tous les masques sont noirs : le modèle n’enferme rien que le milieu d’une couche rencontre ; vérifiez le modèle, ou choisissez des couches plus fines.",
  "uniform-only": ({ format, others, best }) =>
    `Les fichiers ${format} ont une seule épaisseur pour toutes les couches, et ce plan en a plusieurs ; choisissez ${others.join(", ")}, ou ${inPlace(best, { count, mm })}.`,
  "printer-uniform-only": ({ model, best }) =>
    `L’imprimante ${model} n’admet qu’une épaisseur pour toutes les couches, et ce plan en a plusieurs ; choisissez ${inPlace(best, { count, mm })}.`,
  "weights-not-weights": () => "Ce n’est pas un fichier de poids : il ne commence pas par CUSPWT01, ou il est tronqué.",
  "weights-other-mesh": ({ weights_facets, mesh_facets }) =>
    `Ces poids sont d’un autre maillage, de ${counted(weights_facets, FACETS)} ; celui-ci en a ${count(mesh_facets)} ; ` +
    "peignez-le à nouveau, ou ouvrez le modèle pour lequel ils ont été faits.",
  "weights-out-of-range": ({ facet, weight }) =>
    `Le poids de la facette ${count(facet)} est ${exact(weight)}, et les poids vont de 0 à 1.`,
  "price-out-of-bounds": ({ field, value, least, most }) =>
    `${field} vaut ${exact(value)}, mais doit être entre ${exact(least)} et ${exact(most)} ; corrigez les prix ou la commande.`,
  "bad-prices": ({ field }) =>
    `Des prix ne peuvent avoir ce ${field} : une devise a trois capitales selon ISO 4217, les paliers croissent, et chaque finition a son propre nom.`,
  "no-finish": ({ finish, known }) => `Il n’y a pas de finition ${finish} ; ${known.length > 0 ? `sont connues ${known.join(", ")}` : "les prix n’en nomment aucune"}.`,
  "no-masks": ({ format }) =>
    `Les fichiers ${format} contiennent un modèle et ses couches, mais pas de masques ; découpez le modèle lui-même dans ce format, ou choisissez-en un autre.`,
  "other-first-layer": ({ layer_mm, first_layer_mm }) =>
    `La première couche de ce plan fait ${mm(layer_mm)}, et non ${mm(first_layer_mm)} comme réglé ; le modèle est plus bas, choisissez donc une première couche plus fine.`,
  "archive-write": ({ system }) => `Le fichier d’impression n’a pas pu être écrit : ${ended(system)}`,
  cancelled: () => "Annulé.",
  "bad-attribute": ({ attribute, value, known }) =>
    `L’attribut ${attribute} ne peut être ${String(value)}${known === undefined ? "" : ` ; sont connus ${known.join(", ")}`}.`,
  "part-failed": ({ part, system }) => `Une partie de la page n’a pas pu être chargée : ${part} (${system}).`,
  "no-browser": () => "Il n’y a pas de navigateur ici ; appelez cela dans la page.",
  "no-model": () => "Il n’y a pas encore de modèle ; ouvrez-en un d’abord.",
  "file-unreadable": () => "Il a peut-être été déplacé, modifié ou verrouillé. Choisissez-le à nouveau.",
  "bad-source": ({ given }) =>
    `Aucun modèle ne peut être lu dans ${given} ; passez un fichier, ses octets ou un flux d’octets, une adresse, une réponse ou les positions de ses facettes.`,
  "bad-facets": ({ list, numbers, multiple_of }) => `La liste ${list} a ${count(numbers)} nombres, et il en faut un multiple de ${exact(multiple_of)}.`,
  "bad-index": ({ place, index, vertices }) =>
    `L’indice à la place ${count(place)} est ${exact(index)}, qui n’est pas un sommet : il y en a ${count(vertices)}, à partir de 0.`,
  "bad-number": ({ argument, value }) => `L’argument ${argument} est ${String(value)} et doit être un nombre entier à partir de 0.`,
  "dropped-link": () => "Ceci est un lien, pas un fichier. Téléchargez le modèle, puis déposez le fichier ici.",
  "folder-without-model": () => "Le dossier ne contient aucun fichier STL, 3MF ou OBJ. Déposez celui des modèles, ou un modèle.",
  "fetch-failed": (detail) =>
    "status" in detail ? `Aucun fichier à cette adresse (HTTP ${detail.status}).` : `L’adresse n’a pas répondu (${detail.system}).`,
  "worker-failed": ({ system }) =>
    `Rechargez la page. Sinon, prévenez son responsable : un script manque, ou la politique de la page interdit le worker. (${system})`,
  "start-failed": ({ system }) => `Rechargez la page. Sinon, ce navigateur est peut-être trop ancien pour WebAssembly. (${system})`,
  crash: ({ system }) =>
    `La mémoire a peut-être manqué. Il a redémarré : réessayez, avec moins de rayons si le modèle est grand. (${system})`,
});
