/** The texts of the workbench around the panels. */
import { room } from "../texts/messages.js";

export const workbenchWords = room("workbench", {
  /** Label of the buttons for sheets other than steps. */
  choices: "Look into the result",
  /** Label of the row of tabs. */
  answers: "Result",
  mask: "Mask",
  result: "Result",
  /** Label of the button that opens the sheet with the result. */
  more: "Show the result",
  /** Label of the slider next to the view. */
  layer: "Layer in the view",
  /** Exposure of a layer of this thickness. */
  exposure: "{seconds} of light for {thickness}",
  /** Shown if uniform layers were chosen for a printer that takes no others. */
  oneThickness: "{taker} takes one thickness for all layers, so they are uniform: {uniform} instead of {adaptive}.",
  /** Label of the row of steps. */
  path: "Steps",
  steps: { turn: "Orient", check: "Check", hollow: "Hollow", support: "Support", slice: "Slice" },
  /** Purpose of each step. */
  hints: {
    turn: "The orientation decides what needs support, and how long the print takes.",
    check: "What would fail in print, and where it is.",
    hollow: "A hollow model takes less resin and pulls less at the film.",
    support: "Islands and overhangs need supports.",
  },
  prepare: "Prepare automatically",
  prepareHint: "Turns the model, supports it, hollows a large one, and checks the result.",
  back: "Back",
  next: "Next: {step}",
  /** Labels of buttons that activate a tool of the view. */
  byHand: { rotate: "Turn by hand", drains: "Place holes by hand", supports: "Place points by hand" },
  /** Replaces features that a slicer for filament printers has itself. */
  filament: "Slicers of filament printers do this themselves.",
  /** The findings in one line, which leads to them. */
  findings: {
    checking: "Checking …",
    unchecked: "Not checked",
    none: "No problems found",
    review: "{kinds|one:# thing to look at|other:# things to look at}",
    reject: "{kinds|one:# thing will fail|other:# things will fail}",
  },
  /** Progress of each step in a few words. */
  states: {
    asFile: "As in the file",
    turned: "Turned",
    unchecked: "Not checked",
    verdicts: { ok: "Nothing found", review: "Worth a look", reject: "Will fail" },
    solid: "Solid",
    walls: "Walls of {thickness}",
    supports: "{strength}, {points|one:# point|other:# points}",
    /** Supports that the file has. */
    inFile: "In the file",
    /** Number of points that no support reaches. */
    missing: "{points|one:# point|other:# points} without a support",
    /** A field of the step is invalid. */
    wrong: "To be corrected",
  },
});
