import type { ViewWords } from "../en/view.js";
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

export const view = ({ counted }: Format): ViewWords => ({
  view: {
    region: "Le modèle en trois dimensions",
    title: "Modèle",
    kind: "Vue 3D",
    keys: {
      turn: "Les flèches tournent la vue, plus et moins zooment, 0 montre tout le modèle.",
      move: "Les flèches déplacent la copie choisie de 1 mm, avec Maj de 10 mm ; R la tourne de 15°, avec Maj de 45°.",
      rotate: "Les flèches, Page préc. et Page suiv. tournent le modèle de 5°, avec Maj de 1°.",
      flat: "Entrée pose sur le plateau la face du milieu. Les flèches tournent la vue.",
      paint: "Entrée peint au milieu de la vue, Ctrl+Z annule. Les flèches tournent la vue.",
      supports: "Entrée ajoute un point au milieu de la vue. Les flèches passent d’un point à l’autre, Suppr le supprime, L le verrouille. Les flèches avec Maj tournent la vue.",
      drains: "Entrée ajoute un trou au milieu de la vue. Les flèches passent d’un trou à l’autre, Suppr le supprime, L le verrouille. Les flèches avec Maj tournent la vue.",
    },
    empty: "Pas encore de modèle",
    legend: "Épaisseur de couche (µm)",
    heat: "Combien cela compte",
    distance: "Écart au modèle (µm)",
    walls: "Épaisseur des parois (mm)",
    layers: (count) => counted(count, LAYERS),
    layer: (layer, height, thickness) => `Couche ${layer} · ${height} · ${thickness}`,
    grid: (step) => `Grille ${step}`,
    building: (part) => `Calcul des marches : ${part}`,
    measuring: (part) => `Mesure des écarts : ${part}`,
    thin: (least) => `Plus minces que ${least}`,
    probing: (part) => `Mesure des parois : ${part}`,
    unavailable: "Ce navigateur n’affiche pas la vue 3D : WebGL 2 est désactivé ou absent.",
    lost: "Le navigateur a arrêté la vue 3D. Le modèle et son plan sont toujours là.",
    again: "Afficher de nouveau",
    tools: { turn: "Regarder autour", move: "Déplacer sur le plateau", rotate: "Tourner le modèle", flat: "Poser une face", paint: "Ce qui compte", supports: "Points de support", drains: "Trous d’évacuation" },
    modes: "Mode",
    switches: "Affichage",
    impossible: "Ces outils ont besoin de la vue 3D, qui n’est pas disponible.",
    printed: "Comme imprimé",
    measured: "Écart au modèle",
    safe: "Pour daltoniens",
    aligned: "À côté du profil",
    upright: "Comme dans le fichier",
  },
});
