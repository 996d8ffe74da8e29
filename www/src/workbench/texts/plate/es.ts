/** Spanish. */
import type { PlateWords } from "./index.js";

export const words: PlateWords = {
  title: "Modelos en la placa",
  remove: (name) => `Quitar ${name}`,
  spacing: "Separación (mm)",
  turns: "Giros",
  turnless: "Ninguno",
  step: (degrees) => `En pasos de ${degrees}°`,
  plate: (number, count) => `Placa ${number} de ${count}`,
  previous: "Placa anterior",
  next: "Placa siguiente",
  each: (time, resin) => `${time}, ${resin} c/u`,
  whole: (time, resin) => `Todas las placas: ${time}, ${resin}`,
  all: "Descargar todas las placas",
  moved: "Las copias están donde se movieron.",
};
