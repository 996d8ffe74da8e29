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
  notices: {
    part: "This part of the page could not be loaded; a newer version may have replaced it. Reload the page.",
    reader: (name) => `The reader of print files could not be loaded, so ${name} is not open. Reload the page, and open the file again.`,
    notKept: (name) => `${name} was not kept for the next visit: this browser has no room for it, or does not allow it.`,
    reload: "Reload",
    close: "Close",
  },
  points: [
    ["Fewest layers", "Every plan that keeps your tolerance is considered, and the shortest is taken."],
    ["No step too high", "The tolerance holds in each layer, not on average."],
    ["A file to print", "For printers by name, or as images of the layers with their thickness, in a zip."],
  ],
};
