import type { ProblemTexts } from "../en/problems.js";
import type { Format } from "../format.js";
import { LAYERS, FACETS, OMITTED, EDGES, HOLES } from "./nouns.js";

export const problems = ({ counted, plural }: Format): ProblemTexts => ({
  offers: {
    tolerance: (error) => `Tolerancia ${error}`,
    layersFrom: (thickness) => `Capas desde ${thickness}`,
    rays: (count) => `${count} rayos`,
    scale: (height) => `Escalar a ${height}`,
    uniform: (thickness) => `Capas uniformes de ${thickness}`,
    images: "Guardar como imágenes",
    noPrinter: "Sin impresora",
    again: "Intentar de nuevo",
  },
  problems: {
    notStl: (name) => [
      `${name} no es un archivo STL`,
      "Cusp lee archivos STL binarios y de texto: exporte su modelo como STL y suéltelo aquí.",
    ],
    empty: (name) => [`${name} está vacío`, "El archivo no contiene facetas. Exporte el modelo de nuevo como STL."],
    cutShort: (name) => [`${name} está cortado`, "Falta el final del archivo. Cópielo o expórtelo de nuevo."],
    damaged: (name) => [`${name} está dañado`, "Exporte el modelo de nuevo como STL y suelte el archivo nuevo."],
    unusable: (name) => [`${name} no se puede cortar`, "El modelo no tiene extensión o sus coordenadas son demasiado grandes."],
    tooLarge: () => ["El modelo es demasiado grande para esta impresora", "Es más ancho o profundo que su imagen."],
    tooHigh: () => ["El modelo es demasiado alto para esta impresora", "Es más alto que su volumen de impresión."],
    tooFine: () => ["Esta resolución es demasiado para este ordenador", "Elija una más gruesa."],
    noHits: (name) => [`${name} es demasiado fino para estos píxeles`, "Ningún píxel toca el modelo. Elija más resolución."],
    allBlack: () => ["Todas las máscaras serían negras", "El modelo no encierra nada. Revíselo o elija capas más finas."],
    layerTooThick: () => ["Las capas son demasiado gruesas para este modelo", "Elija capas más finas."],
    rangeEmpty: () => ["Ningún paso entero del motor cabe en este intervalo", "Amplíe el intervalo de espesores."],
    doNotFit: () => ["Estas capas no suman la altura del modelo", "Amplíe el intervalo de espesores."],
    notWhole: () => ["Estas longitudes no encajan", "Una de ellas no es un múltiplo del paso."],
    badRange: () => ["Estos intervalos de altura no encajan", "Se solapan o están al revés."],
    badPlane: () => ["No puede haber un plano a esta altura", "Debe estar dentro del modelo."],
    badTime: () => ["Estos tiempos no son posibles", "Escriba segundos desde 0."],
    badOptions: () => ["Estos ajustes no encajan", "Uno de ellos es desconocido o contradice a otro."],
    outOfReach: () => ["Ningún plan es tan corto", "Permita más capas, más tiempo o capas más gruesas."],
    gpu: () => ["No se pudo usar la GPU", "Sin ella calcula la CPU."],
    gpuTooSmall: () => ["La GPU es demasiado pequeña para este modelo", "Sin ella calcula la CPU."],
    uniformOnly: () => [
      "Este archivo solo admite capas uniformes",
      "Tiene un solo espesor para todas las capas, y este plan tiene varios.",
    ],
    unreadable: (name) => [`No se pudo abrir ${name}`, "Quizá se movió, cambió o está bloqueado. Elíjalo de nuevo."],
    notFetched: (name) => [`No se pudo descargar ${name}`, "En esa dirección no había un archivo. Inténtelo de nuevo."],
    startFailed: (_, message) => [
      "No se pudo iniciar el programa",
      `Recargue la página. Si no ayuda, quizá este navegador es demasiado antiguo para WebAssembly. (${message})`,
    ],
    crash: (_, message) => [
      "El programa se detuvo",
      `Quizá se agotó la memoria. Se ha reiniciado: inténtelo de nuevo, con menos rayos si el modelo es grande. (${message})`,
    ],
    notWeights: (name) => [`${name} no contiene pesos`, "Elija un archivo de pesos guardado para este modelo."],
    otherMesh: (name) => [`${name} es de otro modelo`, "Elija un archivo de pesos guardado para este modelo."],
    other: (_, message) => ["No ha funcionado", message],
  },
  infeasible: {
    title: (tolerance) => `Ningún plan respeta ${tolerance} en toda la altura`,
    where: (from, to, thinnest) =>
      `De ${from} a ${to}, incluso una capa de ${thinnest}, la más fina permitida, deja un error mayor.`,
    either: "Permita un error mayor, o capas más finas si su impresora puede hacerlas.",
    larger: "Permita un error mayor.",
    thinner: "Permita capas más finas si su impresora puede hacerlas.",
    neither: "Cambie el intervalo de capas.",
  },
  otherKind: {
    title: (name, kind) => `${name} es un archivo de otro tipo: ${kind}`,
    model: "Cusp lee STL. Exporte el modelo como STL y abra ese archivo.",
    packed: "Descomprímalo y abra el STL que contiene.",
    page: "Esto es una página web, no un modelo. Descargue el modelo mismo: quizá la dirección pida iniciar sesión o lleve a una página sobre él.",
  },
  warnings: {
    "degenerate-facets": (facets) => `${counted(facets, FACETS)} sin área, ${plural(facets, OMITTED)}.`,
    "inside-out": () => "La malla estaba del revés y se le dio la vuelta.",
    "open-mesh": (edges, holes) =>
      `La malla no está cerrada: ${counted(edges, EDGES)} sin pareja, ${counted(holes, HOLES)} con planos. Mire las máscaras.`,
    "unclosed-rays": (unclosed, rays) =>
      `${unclosed} de ${rays} rayos atraviesan agujeros de la malla, tapados con planos. Mire las máscaras.`,
    "tolerance-exceeded": (error, tolerance) => `El error llega a ${error}, más que la tolerancia de ${tolerance}.`,
    "tolerance-exceeded-on-mesh": (error, tolerance) =>
      `En la propia malla el error llega a ${error}, más que la tolerancia de ${tolerance}: los rayos no ven una parte de la superficie.`,
    "sampled-sections": () => "La superficie se cruza consigo misma; las secciones se cuentan a lo largo de rayos.",
    "top-moved": (top, height) => `La impresión termina en ${top}, porque las capas no suman exactamente ${height}.`,
    "black-layers": (layers, from) =>
      `${counted(layers, LAYERS)} sin ningún píxel iluminado, desde ${from}: hay partes en el aire o más finas que un píxel. Mire ahí las máscaras.`,
    "gpu-too-small": () => "El modelo no cabe en la memoria de la GPU; la CPU hizo su trabajo.",
    "gpu-failed": (reason) => `La GPU falló y la CPU hizo su trabajo. (${reason})`,
  },
});
