import type { Format } from "../../texts/format.js";
import type { ErrorSentences, FaultSentences, FindingSentences, PrintWords } from "./index.js";

const LAYERS = { one: "couche", other: "couches" };
const KNOWN = "GOO, PRZ, CTB non chiffré, fichiers Anycubic, NanoDLP, SL1, UVJ ou zip de masques";

export const words = ({ count, counted }: Format): PrintWords => ({
  region: "Fichier d’impression",
  back: "Fermer",
  another: "Ouvrir un autre fichier",
  reading: (name) => `Lecture de ${name}`,
  cancel: "Annuler",
  whole: "Le fichier est complet : toutes les couches sont lisibles et les hauteurs montent depuis le plateau.",
  warnings: (number) => (number === 1 ? "Un point à vérifier" : `${count(number)} points à vérifier`),
  facts: {
    format: "Format",
    software: "Écrit par",
    printer: "Imprimante",
    plate: "Volume d’impression",
    masks: "Masques",
    layers: "Couches",
    height: "Hauteur",
    exposure: "Exposition",
    bottom: "Couches de fond",
    time: "Temps d’impression",
    resin: "Résine",
  },
  pixels: (width, height, side) => `${width} × ${height} pixels de ${side}`,
  mirrored: "en miroir",
  thickness: (layers, range) => `${counted(layers, LAYERS)} de ${range}`,
  ignored: "l’imprimante ignore les valeurs propres à chaque couche",
  range: (least, greatest) => `${least} à ${greatest}`,
  bottomOf: (layers, exposure) => `${count(layers)}, ${exposure} chacune`,
  stated: (stated, lit) => `${stated} selon le fichier, ${lit} selon les masques`,
  lit: (lit) => `${lit} selon les masques`,
  preview: "Aperçu contenu dans le fichier",
  layer: (layer, exposure, lit) => `Couche ${count(layer)} : ${[exposure, lit].filter((it) => it !== "").join(", ")}`,
  exposed: (exposure) => `exposée ${exposure}`,
  pixelsLit: (pixels) => counted(pixels, { one: "pixel allumé", other: "pixels allumés" }),
  damaged: "Cette couche est illisible.",
  rough: "La vue 3D est plus grossière que l’impression.",
  noSurface: "Cette impression a trop de détails pour la vue 3D.",
});

export const faults = ({ count }: Format): FaultSentences => ({
  "missing-mask": ({ name }) => `${name} est absent`,
  "bad-mask": ({ name, system }) => `${name} est endommagé (${system})`,
  "mask-size": ({ name, width, height, columns, rows }) =>
    `${name} fait ${width} × ${height} pixels alors que les réglages en demandent ${columns} × ${rows}`,
  "outside-file": ({ end_byte, file_bytes }) => `ses données finissent à l’octet ${count(end_byte)}, le fichier à l’octet ${count(file_bytes)}`,
  "bad-run": ({ byte }) => `l’octet ${count(byte)} de ses données n’est pas une suite de pixels`,
  "too-few-pixels": ({ pixels, expected }) => `ses données couvrent ${count(pixels)} pixels sur ${count(expected)}`,
  "too-many-pixels": ({ expected }) => `ses données couvrent plus de ${count(expected)} pixels`,
  "wrong-checksum": ({ stated, computed }) => `sa somme de contrôle est ${stated}, celle de ses données ${computed}`,
});

export const findings = ({ count, counted, mm, height }: Format): FindingSentences => ({
  "no-layers": () => "Le fichier n’a aucune couche ; découpez à nouveau le modèle.",
  "bad-heights": ({ layers, first_layer }) =>
    `${counted(layers, { one: "couche finit", other: "couches finissent" })} à une hauteur qui n’est pas un nombre, d’abord la couche ${count(first_layer)} ; exportez à nouveau le fichier.`,
  "bad-exposures": ({ layers, first_layer }) =>
    `${counted(layers, { one: "couche a", other: "couches ont" })} une exposition qui n’est pas un nombre, d’abord la couche ${count(first_layer)} ; vérifiez les expositions et exportez à nouveau le fichier.`,
  "bad-nominal-values": () =>
    "L’épaisseur de couche ou une exposition pour toutes les couches n’est pas un nombre ; vérifiez les réglages et exportez à nouveau le fichier.",
  "first-layer-below-plate": ({ z_mm }) =>
    `La première couche finit à ${mm(z_mm)}, pas au-dessus du plateau ; découpez à nouveau le modèle.`,
  "heights-not-ascending": ({ layers, first_layer, z_mm, below_mm }) =>
    `${counted(layers, { one: "couche ne finit", other: "couches ne finissent" })} pas au-dessus de la précédente, d’abord la couche ${count(first_layer)}, à ${mm(z_mm)} après ${mm(below_mm)} ; découpez à nouveau le modèle.`,
  "ignored-heights": ({ thinnest_mm, thickest_mm, layer_mm }) =>
    `Les couches font de ${mm(thinnest_mm)} à ${mm(thickest_mm)} d’épaisseur, mais le fichier dit à l’imprimante de ne pas en tenir compte` +
    `${layer_mm === null ? "" : ` et de monter de ${mm(layer_mm)} à chaque fois`} ; exportez-le avec des valeurs pour chaque couche, ou prenez des couches d’une seule épaisseur.`,
  "no-exposure": ({ layers, first_layer }) =>
    `${counted(layers, { one: "couche n’a", other: "couches n’ont" })} pas d’exposition, d’abord la couche ${count(first_layer)} ; vérifiez les expositions et exportez à nouveau le fichier.`,
  "black-layers": ({ layers, first_layer, from_mm }) =>
    `${counted(layers, { one: "couche est noire", other: "couches sont noires" })}, d’abord la couche ${count(first_layer)}, à partir de ${height(from_mm)} : rien n’y est imprimé ; regardez les masques.`,
  "bad-layers": ({ layers, first_layer }, fault) =>
    `${counted(layers, { one: "couche est endommagée", other: "couches sont endommagées" })}, d’abord la couche ${count(first_layer)} : ${fault} ; copiez ou exportez à nouveau le fichier.`,
  "missing-marks": ({ layers, first_layer }) =>
    `Il manque à ${counted(layers, LAYERS)} les octets finaux 0D 0A, d’abord à la couche ${count(first_layer)} ; copiez ou exportez à nouveau le fichier.`,
  "missing-end": () => "Le fichier ne finit pas comme il le devrait ; copiez-le à nouveau, il est peut-être tronqué.",
  "bad-preview": ({ preview }) =>
    `L’aperçu ${count(preview)} est endommagé ; l’écran de l’imprimante peut afficher du bruit, l’impression n’en souffre pas.`,
});

export const errors = ({ count }: Format): ErrorSentences => ({
  "unknown-kind": () => `Ce n’est pas un fichier d’impression lisible ; ouvrez ${KNOWN}.`,
  "damaged-zip": ({ system }) => `Le zip est endommagé (${system}) ; copiez-le ou exportez-le à nouveau.`,
  "unknown-zip": () => `Ce zip ne contient les réglages d’aucun format connu, comme run.gcode ou manifest.json ; ouvrez ${KNOWN}.`,
  model: ({ has_layers }) =>
    has_layers
      ? "Ce 3MF est un modèle avec des couches pour les trancheurs d’imprimantes à filament et n’a pas de masques ; ouvrez-le dans ce trancheur, ou ouvrez-le ici comme modèle et tranchez-le pour une imprimante à résine."
      : "Ce 3MF est un modèle et n’a pas de masques ; ouvrez-le comme modèle et tranchez-le.",
  "encrypted-ctb": () =>
    "Ce fichier CTB est chiffré et illisible sans la clé du fabricant ; enregistrez-le en CTB non chiffré, en GOO ou en zip de masques.",
  unread: ({ kind }) =>
    ({
      cbddlp: "C’est un fichier cbddlp ou photon des premières imprimantes ChiTuBox, qui ne peut pas être lu ; enregistrez-le en CTB non chiffré ou en GOO.",
      "planes-of-bits": "Ce fichier Photon Workshop contient un plan de bits par niveau de gris et ne peut pas être lu ; enregistrez-le en GOO ou en zip de masques.",
      outlines: "Ce zip Anycubic contient des contours au lieu de masques et ne peut pas être lu ; enregistrez-le en GOO ou en zip de masques.",
    })[kind],
  "unknown-version": ({ version, known }) => `La version ${version} de ce format ne peut pas être lue ; enregistrez le fichier en version ${known}.`,
  truncated: ({ needed_bytes, found_bytes }) =>
    `Le fichier est tronqué : ses réglages demandent ${count(needed_bytes)} octets et il en a ${count(found_bytes)} ; copiez-le ou exportez-le à nouveau.`,
  "too-many-layers": ({ layers, most }) =>
    `Le fichier annonce ${count(layers)} couches et a de la place pour ${count(most)} au plus ; copiez-le ou exportez-le à nouveau.`,
  "missing-file": ({ name }) => `Il manque au zip ${name}, sur lequel ses réglages comptent ; exportez-le à nouveau.`,
  "bad-file": ({ name, system }) => `${name} est illisible (${system}) ; exportez à nouveau le fichier.`,
  "too-large": ({ name, most_bytes }) => `${name} dépasse ${count(most_bytes)} octets une fois décompressé ; exportez à nouveau le fichier.`,
  "bad-setting": ({ file, setting }) => `${file} n’indique pas ${setting} de façon lisible ; exportez à nouveau le fichier.`,
  "too-many-pixels": ({ width, height, max_side }) =>
    `Les masques font ${count(width)} × ${count(height)} pixels, et le maximum est de ${count(max_side)} par côté.`,
  layer: ({ layer }, fault) => `La couche ${count(layer)} est illisible : ${fault} ; exportez à nouveau le fichier.`,
  "file-unreadable": () => "Le fichier est illisible. A-t-il été déplacé ou supprimé ? Choisissez-le à nouveau.",
  crash: ({ system }) => `La lecture s’est arrêtée de façon inattendue (${system}). Réessayez.`,
});
