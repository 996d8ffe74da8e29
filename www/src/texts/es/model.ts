import type { ModelTexts } from "../en/model.js";

export const model = (): ModelTexts => ({
  open: {
    region: "Abrir un modelo",
    drop: "Suelte un modelo aquí",
    choose: "Elegir un archivo",
    another: "Abrir otro",
    opening: (name) => `Abriendo ${name}`,
    place: (place, total) => `Modelo ${place} de ${total}`,
    previous: "Modelo anterior",
    next: "Modelo siguiente",
  },
  model: {
    region: "El modelo",
    size: "Tamaño",
    sizeHelp: "ancho × fondo × alto",
    scaled: (from) => `escalado desde ${from}`,
    facets: "Facetas",
    surface: "Superficie",
    closed: "Cerrada",
    open: "No cerrada",
  },
  progress: {
    load: "Leyendo el modelo",
    saliency: "Buscando lo que destaca",
    ldi: "Explorando la forma",
    profile: "Midiendo la superficie",
    plan: "Planificando las capas",
    masks: "Dibujando las capas",
    inspect: "Buscando lo que fallará",
    orientation: "Midiendo direcciones",
    left: (seconds) => `quedan unos ${seconds}`,
    cancel: "Cancelar",
  },
  notices: {
    cancelled: "Cancelado.",
    exportCancelled: "Se canceló la descarga.",
    partFailed: "No se pudo cargar esta parte de la página. Compruebe la conexión e inténtelo de nuevo; si no ayuda, recargue la página.",
    close: "Cerrar",
  },
});
