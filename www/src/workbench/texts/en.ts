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
  plate: {
    add: "Add model",
    copies: "Copies",
    copiesOf: (name) => `Copies of ${name}`,
    fewer: "One fewer",
    more: "One more",
    arrange: "Arrange",
    quality: "The curve of quality is of one model. A plate is planned for the tolerance in the settings.",
  },
};
