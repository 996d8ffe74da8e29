/** Spanish. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Ver el resultado",
  answers: "Qué sale",
  mask: "Máscara",
  result: "Resultado",
  more: "Mostrar el resultado",
  layer: "Capa en la vista",
  exposure: (seconds, thickness) => `${seconds} de exposición para ${thickness}`,
  path: "Pasos",
  steps: { turn: "Girar", check: "Revisar", hollow: "Ahuecar", support: "Soportes", slice: "Laminar" },
  hints: {
    turn: "De la posición del modelo depende qué necesita soportes y cuánto tarda.",
    check: "Qué fallaría al imprimir, y dónde está.",
    hollow: "Un modelo hueco gasta menos resina y tira menos de la película.",
    support: "Lo que empieza en el aire o sobresale mucho necesita soportes.",
    slice: "Diga con qué imprime.",
  },
  back: "Atrás",
  next: (step) => `Siguiente: ${step}`,
  byHand: { rotate: "Girar a mano", drains: "Poner agujeros a mano", supports: "Poner puntos a mano" },
  filament: "Los laminadores de impresoras de filamento lo hacen por sí mismos.",
  states: {
    asFile: "Como en el archivo",
    turned: "Girado",
    unchecked: "Sin revisar",
    verdicts: { ok: "Sin hallazgos", review: "Conviene mirarlo", reject: "Fallará" },
    solid: "Macizo",
    walls: (thickness) => `Paredes de ${thickness}`,
    supports: (strength, points, { counted }) => `${strength}, ${counted(points, { one: "punto", other: "puntos" })}`,
    missing: (points, { counted }) => `${counted(points, { one: "punto", other: "puntos" })} sin soporte`,
    wrong: "Por corregir",
  },
};
