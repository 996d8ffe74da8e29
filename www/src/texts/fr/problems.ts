import type { ProblemTexts } from "../en/problems.js";
import type { Format } from "../format.js";
import { LAYERS, FACETS, OMITTED, EDGES, HOLES } from "./nouns.js";

export const problems = ({ counted, plural }: Format): ProblemTexts => ({
  offers: {
    tolerance: (error) => `Tolérance ${error}`,
    layersFrom: (thickness) => `Couches dès ${thickness}`,
    rays: (count) => `${count} rayons`,
    scale: (height) => `Mettre à ${height}`,
    uniform: (thickness) => `Couches uniformes de ${thickness}`,
    images: "Enregistrer en images",
    noPrinter: "Sans imprimante",
    again: "Réessayer",
  },
  problems: {
    notStl: (name) => [
      `${name} n’est pas un fichier STL`,
      "Cusp lit les fichiers STL binaires et texte : exportez votre modèle en STL et déposez-le.",
    ],
    empty: (name) => [`${name} est vide`, "Le fichier ne contient pas de facettes. Exportez à nouveau le modèle en STL."],
    cutShort: (name) => [`${name} est tronqué`, "La fin du fichier manque. Copiez-le ou exportez-le à nouveau."],
    damaged: (name) => [`${name} est abîmé`, "Exportez à nouveau le modèle en STL et déposez le nouveau fichier."],
    unusable: (name) => [`${name} ne peut être tranché`, "Le modèle n’a pas d’étendue, ou ses coordonnées sont trop grandes."],
    tooLarge: () => ["Le modèle est trop grand pour cette imprimante", "Il est plus large ou profond que son image."],
    tooHigh: () => ["Le modèle est trop haut pour cette imprimante", "Il dépasse son volume d’impression."],
    tooFine: () => ["Cette résolution est trop forte pour cet ordinateur", "Choisissez-en une moindre."],
    noHits: (name) => [`${name} est trop fin pour ces pixels`, "Aucun pixel ne touche le modèle. Augmentez la résolution."],
    allBlack: () => ["Tous les masques seraient noirs", "Le modèle n’enferme rien. Vérifiez-le ou choisissez des couches plus fines."],
    layerTooThick: () => ["Les couches sont trop épaisses pour ce modèle", "Choisissez-les plus fines."],
    rangeEmpty: () => ["Aucun pas entier du moteur n’est dans cet intervalle", "Élargissez l’intervalle d’épaisseurs."],
    doNotFit: () => ["Ces couches ne font pas la hauteur du modèle", "Élargissez l’intervalle d’épaisseurs."],
    notWhole: () => ["Ces longueurs ne vont pas ensemble", "L’une d’elles n’est pas un multiple du pas."],
    badRange: () => ["Ces intervalles de hauteur ne vont pas ensemble", "Ils se chevauchent ou sont à l’envers."],
    badPlane: () => ["Il ne peut y avoir de plan à cette hauteur", "Il doit être dans le modèle."],
    badTime: () => ["Ces durées ne sont pas possibles", "Entrez des secondes à partir de 0."],
    badOptions: () => ["Ces réglages ne vont pas ensemble", "L’un d’eux est inconnu ou en contredit un autre."],
    outOfReach: () => ["Aucun plan n’est aussi court", "Permettez plus de couches, plus de temps ou des couches plus épaisses."],
    gpu: () => ["Le GPU n’a pas pu servir", "Sans lui, le CPU calcule."],
    gpuTooSmall: () => ["Le GPU est trop petit pour ce modèle", "Sans lui, le CPU calcule."],
    uniformOnly: () => [
      "Ce fichier n’admet que des couches uniformes",
      "Il a une seule épaisseur pour toutes les couches, et ce plan en a plusieurs.",
    ],
    unreadable: (name) => [`${name} n’a pas pu être ouvert`, "Il a peut-être été déplacé, modifié ou verrouillé. Choisissez-le à nouveau."],
    notFetched: (name) => [`${name} n’a pas pu être téléchargé`, "Aucun fichier à cette adresse. Réessayez."],
    startFailed: (_, message) => [
      "Le trancheur n’a pas pu démarrer",
      `Rechargez la page. Sinon, ce navigateur est peut-être trop ancien pour WebAssembly. (${message})`,
    ],
    crash: (_, message) => [
      "Le trancheur s’est arrêté",
      `La mémoire a peut-être manqué. Il a redémarré : réessayez, avec moins de rayons si le modèle est grand. (${message})`,
    ],
    notWeights: (name) => [`${name} ne contient pas de poids`, "Choisissez un fichier de poids enregistré pour ce modèle."],
    otherMesh: (name) => [`${name} est d’un autre modèle`, "Choisissez un fichier de poids enregistré pour ce modèle."],
    other: (_, message) => ["Cela n’a pas marché", message],
  },
  infeasible: {
    title: (tolerance) => `Aucun plan ne respecte ${tolerance} sur toute la hauteur`,
    where: (from, to, thinnest) =>
      `De ${from} à ${to}, même une couche de ${thinnest}, la plus fine permise, laisse une erreur plus grande.`,
    either: "Permettez une erreur plus grande, ou des couches plus fines si votre imprimante en est capable.",
    larger: "Permettez une erreur plus grande.",
    thinner: "Permettez des couches plus fines si votre imprimante en est capable.",
    neither: "Changez l’intervalle des couches.",
  },
  otherKind: {
    title: (name, kind) => `${name} est un fichier d’un autre type : ${kind}`,
    model: "Cusp lit le STL. Exportez le modèle en STL et ouvrez ce fichier.",
    packed: "Décompressez-le et ouvrez le STL qu’il contient.",
    page: "C’est une page web, pas un modèle. Téléchargez le modèle lui-même : l’adresse demande peut-être une connexion, ou mène à une page sur le modèle.",
  },
  warnings: {
    "degenerate-facets": (facets) => `${counted(facets, FACETS)} sans aire, ${plural(facets, OMITTED)}.`,
    "inside-out": () => "Le maillage était à l’envers et a été retourné.",
    "open-mesh": (edges, holes) =>
      `Le maillage n’est pas fermé : ${counted(edges, EDGES)} sans vis-à-vis, ${counted(holes, HOLES)} à plat. Regardez les masques.`,
    "unclosed-rays": (unclosed, rays) =>
      `${unclosed} rayons sur ${rays} traversent des trous du maillage, bouchés à plat. Regardez les masques.`,
    "tolerance-exceeded": (error, tolerance) => `L’erreur atteint ${error}, plus que la tolérance de ${tolerance}.`,
    "tolerance-exceeded-on-mesh": (error, tolerance) =>
      `Sur le maillage même l’erreur atteint ${error}, plus que la tolérance de ${tolerance} : les rayons manquent une partie de la surface.`,
    "sampled-sections": () => "La surface se croise ; les sections sont comptées le long des rayons.",
    "top-moved": (top, height) => `L’impression finit à ${top}, car les couches ne font pas exactement ${height}.`,
    "black-layers": (layers, from) =>
      `${counted(layers, LAYERS)} sans pixel éclairé, à partir de ${from} : des parties flottent en l’air ou sont plus fines qu’un pixel. Regardez-y les masques.`,
    "gpu-too-small": () => "Le modèle ne tient pas dans la mémoire du GPU ; le CPU a fait son travail.",
    "gpu-failed": (reason) => `Le GPU a échoué, et le CPU a fait son travail. (${reason})`,
  },
});
