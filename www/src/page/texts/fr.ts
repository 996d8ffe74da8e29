/** French. */
import type { PageWords } from "./index.js";

export const words: PageWords = {
  title: "Cusp : couches adaptatives pour l’impression en résine",
  tagline: "Des couches fines là où la surface en a besoin, épaisses ailleurs.",
  private: "Votre modèle ne quitte jamais cet ordinateur.",
  drop: "Déposez pour ouvrir",
  languages: "Langue",
  noModel: "Pas de modèle sous la main ?",
  tryExample: "Essayer l’exemple",
  printFile: "Examiner un fichier d’impression",
  example: "Exemple",
  recent: "Modèles récents",
  saved: "Préréglages",
  keys: "Touches",
  points: [
    ["Le moins de couches", "Parmi tous les plans qui respectent votre tolérance, le plus court est retenu."],
    ["Aucune marche trop haute", "La tolérance tient dans chaque couche, pas en moyenne."],
    ["Un fichier à imprimer", "Pour des imprimantes connues, ou en images des couches avec leur épaisseur, dans un zip."],
  ],
};
