import type { ModelTexts } from "../en/model.js";

export const model = (): ModelTexts => ({
  open: {
    region: "Ouvrir un modèle",
    drop: "Déposez un modèle ici",
    choose: "Choisir un fichier",
    another: "En ouvrir un autre",
    opening: (name) => `Ouverture de ${name}`,
    place: (place, total) => `Modèle ${place} sur ${total}`,
    previous: "Modèle précédent",
    next: "Modèle suivant",
  },
  model: {
    region: "Le modèle",
    size: "Taille",
    sizeHelp: "largeur × profondeur × hauteur",
    scaled: (from) => `mis à l’échelle depuis ${from}`,
    facets: "Facettes",
    surface: "Surface",
    closed: "Fermée",
    open: "Non fermée",
  },
  progress: {
    load: "Lecture du modèle",
    saliency: "Recherche de ce qui ressort",
    ldi: "Exploration de la forme",
    profile: "Mesure de la surface",
    plan: "Planification des couches",
    masks: "Dessin des couches",
    inspect: "Recherche de ce qui échouera",
    orientation: "Mesure des directions",
    left: (seconds) => `encore ${seconds} environ`,
    cancel: "Annuler",
  },
  notices: {
    cancelled: "Annulé.",
    exportCancelled: "Le téléchargement a été annulé.",
    partFailed: "Cette partie de la page n’a pas pu être chargée. Vérifiez la connexion et réessayez ; si cela ne suffit pas, rechargez la page.",
    close: "Fermer",
  },
});
