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
  notices: {
    part: "Cette partie de la page n’a pas pu être chargée ; une version plus récente l’a peut-être remplacée. Rechargez la page.",
    reader: (name) => `Le lecteur de fichiers d’impression n’a pas pu être chargé, si bien que ${name} n’est pas ouvert. Rechargez la page, puis rouvrez le fichier.`,
    notKept: (name) => `${name} n’a pas été conservé pour la prochaine visite : ce navigateur manque de place ou ne le permet pas.`,
    reload: "Recharger",
    close: "Fermer",
  },
  points: [
    ["Le moins de couches", "Parmi tous les plans qui respectent votre tolérance, le plus court est retenu."],
    ["Aucune marche trop haute", "La tolérance tient dans chaque couche, pas en moyenne."],
    ["Un fichier à imprimer", "Pour des imprimantes connues, ou en images des couches avec leur épaisseur, dans un zip."],
  ],
};
