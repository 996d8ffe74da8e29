/** English. */
import type { PlateWords } from "./index.js";

export const words: PlateWords = {
  title: "Models on the plate",
  remove: (name) => `Remove ${name}`,
  spacing: "Spacing (mm)",
  turns: "Turns",
  turnless: "None",
  step: (degrees) => `Steps of ${degrees}°`,
  plate: (number, count) => `Plate ${number} of ${count}`,
  previous: "Previous plate",
  next: "Next plate",
  each: (time, resin) => `${time}, ${resin} each`,
  whole: (time, resin) => `All plates: ${time}, ${resin}`,
  all: "Download all plates",
  moved: "Copies stand where they were moved.",
};
