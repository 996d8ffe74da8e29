/** English. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "Look into the result",
  answers: "What comes out",
  mask: "Mask",
  result: "Result",
  more: "Show the result",
  layer: "Layer in the view",
  exposure: (seconds, thickness) => `${seconds} of light for ${thickness}`,
  path: "Steps",
  steps: { turn: "Turn", check: "Check", hollow: "Hollow", support: "Support", slice: "Slice" },
  hints: {
    turn: "How the model lies decides what needs support, and how long it prints.",
    check: "What would fail in print, and where it is.",
    hollow: "A hollow model takes less resin and pulls less at the film.",
    support: "Whatever begins in the air or leans far out needs a support.",
    slice: "Say what you print with.",
  },
  back: "Back",
  next: (step) => `Next: ${step}`,
  byHand: { rotate: "Turn by hand", drains: "Place holes by hand", supports: "Place points by hand" },
  filament: "Slicers of filament printers do this themselves.",
  states: {
    asFile: "As in the file",
    turned: "Turned",
    unchecked: "Not checked",
    verdicts: { ok: "Nothing found", review: "Worth a look", reject: "Will fail" },
    solid: "Solid",
    walls: (thickness) => `Walls of ${thickness}`,
    supports: (strength, points, { counted }) => `${strength}, ${counted(points, { one: "point", other: "points" })}`,
    missing: (points, { counted }) => `${counted(points, { one: "point", other: "points" })} without a support`,
    wrong: "To be corrected",
  },
};
