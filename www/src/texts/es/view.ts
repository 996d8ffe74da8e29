import type { ViewWords } from "../en/view.js";
import type { Format } from "../format.js";
import { LAYERS } from "./nouns.js";

export const view = ({ counted }: Format): ViewWords => ({
  view: {
    region: "El modelo en tres dimensiones",
    title: "Modelo",
    kind: "Vista 3D",
    keys: {
      turn: "Las flechas giran la vista, más y menos acercan y alejan, 0 muestra todo el modelo.",
      move: "Las flechas mueven la copia elegida 1 mm, con Mayús 10 mm; R la gira 15°, con Mayús 45°.",
      rotate: "Las flechas, Re Pág y Av Pág giran el modelo 5°, con Mayús 1°.",
      flat: "Intro apoya en la base la cara del centro. Las flechas giran la vista.",
      paint: "Intro pinta en el centro de la vista, Ctrl+Z lo deshace. Las flechas giran la vista.",
      supports: "Intro añade un punto en el centro de la vista. Las flechas pasan de un punto a otro, Supr lo elimina, L lo bloquea. Las flechas con Mayús giran la vista.",
      drains: "Intro añade un agujero en el centro de la vista. Las flechas pasan de un agujero a otro, Supr lo elimina, L lo bloquea. Las flechas con Mayús giran la vista.",
    },
    empty: "Aún no hay modelo",
    legend: "Espesor de capa (µm)",
    heat: "Cuánto importa",
    distance: "Distancia al modelo (µm)",
    walls: "Grosor de las paredes (mm)",
    layers: (count) => counted(count, LAYERS),
    layer: (layer, height, thickness) => `Capa ${layer} · ${height} · ${thickness}`,
    grid: (step) => `Cuadrícula ${step}`,
    building: (part) => `Calculando los escalones: ${part}`,
    measuring: (part) => `Midiendo las distancias: ${part}`,
    thin: (least) => `Más finas que ${least}`,
    probing: (part) => `Midiendo las paredes: ${part}`,
    unavailable: "Este navegador no muestra la vista 3D: WebGL 2 está desactivado o falta.",
    lost: "El navegador ha detenido la vista 3D. El modelo y su plan siguen ahí.",
    again: "Mostrar de nuevo",
    tools: { turn: "Mirar alrededor", move: "Mover en la placa", rotate: "Girar el modelo", flat: "Apoyar una cara", paint: "Qué importa", supports: "Puntos de soporte", drains: "Agujeros de drenaje" },
    modes: "Modo",
    switches: "Visualización",
    impossible: "Estas herramientas necesitan la vista 3D, que no está disponible.",
    printed: "Como impreso",
    measured: "Distancia al modelo",
    safe: "Para daltónicos",
    aligned: "Junto al perfil",
    upright: "Como en el archivo",
  },
});
