/** English. */
import type { PageWords } from "./index.js";

export const words: PageWords = {
  title: "Cusp: adaptive layers for resin printing",
  tagline: "Thin layers where the surface needs them, thick ones where it does not.",
  private: "Your model never leaves this computer.",
  drop: "Drop to open",
  languages: "Language",
  noModel: "No model at hand?",
  tryExample: "Try the example",
  printFile: "Look into a print file",
  example: "Example",
  recent: "Recent models",
  saved: "Presets",
  keys: "Keys",
  points: [
    ["Fewest layers", "Every plan that keeps your tolerance is considered, and the shortest is taken."],
    ["No step too high", "The tolerance holds in each layer, not on average."],
    ["A file to print", "For printers by name, or as images of the layers with their thickness, in a zip."],
  ],
};
