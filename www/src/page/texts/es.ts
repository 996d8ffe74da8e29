import type { PageWords } from "./index.js";

export const words: PageWords = {
  title: "Cusp: capas adaptativas para impresión en resina",
  tagline: "Capas finas donde la superficie las necesita, gruesas donde no.",
  private: "Su modelo nunca sale de este ordenador.",
  drop: "Suelte para abrir",
  languages: "Idioma",
  noModel: "¿No tiene un modelo a mano?",
  tryExample: "Probar el ejemplo",
  printFile: "Examinar un archivo de impresión",
  example: "Ejemplo",
  recent: "Modelos recientes",
  saved: "Perfiles",
  keys: "Teclas",
  notices: {
    part: "No se pudo cargar esta parte de la página; quizá la sustituyó una versión más reciente. Recargue la página.",
    reader: (name) => `No se pudo cargar el lector de archivos de impresión, así que ${name} no está abierto. Recargue la página y abra el archivo de nuevo.`,
    notKept: (name) => `${name} no se guardó para la próxima visita: este navegador no tiene sitio o no lo permite.`,
    reload: "Recargar",
    close: "Cerrar",
  },
  points: [
    ["El mínimo de capas", "De todos los planes que respetan su tolerancia se toma el más corto."],
    ["Ningún escalón de más", "La tolerancia se cumple en cada capa, no de media."],
    ["Un archivo para imprimir", "Para impresoras conocidas, o como imágenes de las capas con su espesor, en un zip."],
  ],
};
