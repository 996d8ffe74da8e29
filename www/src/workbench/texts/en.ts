/** English. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "What to choose",
  answers: "What comes out",
  mask: "Mask",
  result: "Result",
  more: "Show the result",
  layer: "Layer in the view",
  exposure: (seconds, thickness) => `${seconds} of light for ${thickness}`,
};
