import type { ThreeMfFeature, XmlFault } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { ErrorSentences } from "../sentences.js";

const XML: Readonly<Record<XmlFault, string>> = {
  "cut-short": "elle finit avant ses éléments",
  "not-xml": "elle n’est pas du XML en UTF-8",
  "wrong-end-tag": "une balise de fin ne correspond pas à celle du début",
  attribute: "un attribut n’est pas un nom et une valeur entre guillemets",
  "long-tag": "une balise est trop longue",
  deep: "trop d’éléments sont imbriqués",
  doctype: "elle a un type de document, que 3MF interdit",
};

const FEATURES: Readonly<Record<ThreeMfFeature, string>> = {
  "beam-lattice": "d’un treillis de poutres",
  slices: "de tranches",
  displacement: "de facettes déplacées",
  booleans: "d’opérations booléennes",
  volumetric: "de données volumiques",
};

export const readers = ({ count }: Pick<Format, "count">) =>
  ({
    "threemf-no-directory": () => "Le fichier 3MF est abîmé ou tronqué : son répertoire manque ; copiez-le ou exportez-le à nouveau.",
    "threemf-no-part": ({ part }) => `Il manque au fichier 3MF la partie ${part} ; exportez à nouveau le modèle.`,
    "threemf-damaged-part": ({ part }) => `La partie ${part} du fichier 3MF est abîmée ; copiez-le ou exportez-le à nouveau.`,
    "threemf-packed": ({ part, method }) =>
      `La partie ${part} du fichier 3MF est compressée par la méthode ${count(method)}, chiffrée ou non ; 3MF connaît 0 et 8 ; exportez à nouveau le modèle.`,
    "threemf-too-large": ({ part, most_bytes }) =>
      `La partie ${part} du fichier 3MF décompressée dépasse ${count(most_bytes)} octets, trop pour sa taille ; exportez à nouveau le modèle.`,
    "threemf-xml": ({ part, line, fault }) => `${part}, ligne ${count(line)} : ${XML[fault]} ; exportez à nouveau le modèle.`,
    "threemf-bad-attribute": ({ part, line, attribute, found }) =>
      `${part}, ligne ${count(line)} : \`${found}\` n’est pas une valeur de ${attribute} ; exportez à nouveau le modèle.`,
    "threemf-no-vertex": ({ part, line, vertex, vertices }) =>
      `${part}, ligne ${count(line)} : il n’y a pas de sommet ${count(vertex)} : le maillage en a ${count(vertices)}, à partir de 0 ; exportez à nouveau le modèle.`,
    "threemf-no-object": ({ part, line, object }) =>
      `${part}, ligne ${count(line)} : il n’y a pas d’objet ${count(object)} ; exportez à nouveau le modèle.`,
    "threemf-nested": ({ part, line, object, most_levels }) =>
      `${part}, ligne ${count(line)} : l’objet ${count(object)} est à plus de ${count(most_levels)} niveaux, ou une partie de lui-même ; exportez à nouveau le modèle.`,
    "threemf-too-many": ({ most_facets }) =>
      `Les objets du fichier 3MF se répètent jusqu’à plus de ${count(most_facets)} facettes ; imprimez moins de copies.`,
    "threemf-overflow": ({ part, object }) => `${part} : les coordonnées de l’objet ${count(object)} sont trop grandes pour le calcul ; exportez à nouveau le modèle.`,
    "threemf-feature": ({ part, object, feature }) =>
      `${part} : l’objet ${count(object)} est fait ${FEATURES[feature]}, que Cusp ne lit pas ; exportez le modèle en maillage.`,
    "threemf-encrypted": ({ part }) => `${part} : le modèle est chiffré ; exportez-le sans chiffrement.`,
    "threemf-extension": ({ part, extension }) =>
      `${part} : le modèle exige l’extension ${extension}, que Cusp ne connaît pas ; exportez-le sans elle.`,
    "threemf-no-facets": ({ skipped }) =>
      `Le fichier 3MF n’a pas de facettes à imprimer : ${count(skipped)} de ses objets sont des supports, des surfaces ou ne s’impriment pas ; exportez à nouveau le modèle.`,
    "obj-bad-vertex": ({ line, found }) =>
      `Ligne ${count(line)} : un sommet demande trois nombres finis, et a \`${found}\` ; exportez à nouveau le modèle.`,
    "obj-bad-corner": ({ line, found, vertices }) =>
      `Ligne ${count(line)} : \`${found}\` n’est pas le numéro d’un sommet : le fichier en a ${count(vertices)} ; exportez à nouveau le modèle.`,
    "obj-few-corners": ({ line, corners }) =>
      `Ligne ${count(line)} : une face demande au moins trois coins, et en a ${count(corners)} ; exportez à nouveau le modèle.`,
    "obj-free-form": ({ line, keyword }) =>
      `Ligne ${count(line)} : \`${keyword}\` est une surface libre sans facettes ; exportez le modèle en polygones.`,
    "obj-too-many": ({ line, most_facets }) =>
      `Ligne ${count(line)} : les faces donnent plus de ${count(most_facets)} facettes, trop pour la taille du fichier ; exportez à nouveau le modèle.`,
    "obj-no-faces": () => "L’OBJ ne contient pas de faces ; exportez à nouveau le modèle.",
  }) satisfies Partial<ErrorSentences>;
