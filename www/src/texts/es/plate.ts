import type { PlateTexts } from "../en/plate.js";

export const plate = (): PlateTexts => ({
  plate: {
    add: "Añadir modelo",
    copies: "Copias",
    copiesOf: (name) => `Copias de ${name}`,
    fewer: "Una menos",
    more: "Una más",
    arrange: "Distribuir",
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
    others: (count) => `Y ${count} más.`,
    moved: "Las copias están donde se movieron.",
  },
});
