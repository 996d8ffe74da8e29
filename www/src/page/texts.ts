/** The texts of the page around the element. */
import { room } from "../texts/messages.js";

export const pageWords = room("page", {
  title: "Cusp: adaptive layers for resin printing",
  headline: "Fewer layers, the same surface",
  lead: "For resin printers: Cusp turns, hollows and supports your model, makes its layers thin where the surface needs it and thick where it does not, and writes the file for your printer.",
  private: "Your model stays on this device.",
  drop: "Drop to open",
  /** The same beside open models, and the place where a drop replaces them. */
  dropAdd: "Drop to add to the plate",
  dropReplace: "Drop here to replace",
  /** Label of the language list. */
  languages: "Language",
  tryExample: "Try the example",
  /** Kinds of files that can be opened. */
  files: "STL, 3MF, OBJ, or a print file to look into",
  /** Saves models, supports, painting and settings as one file. */
  saveProject: "Save project",
  /** Buttons of the header: work that this browser keeps, named settings, the list of keys. */
  recent: "Recent work",
  saved: "Presets",
  keys: "Keys",
  /** Heading of the recent work on a page without a model. */
  goOn: "Continue with",
  /** Messages about errors of the page itself, with advice. */
  notices: {
    /** Shown if a part could not be loaded. */
    part: "This part of the page could not be loaded; a newer version may have replaced it. Reload the page.",
    /** Shown if the reader of print files could not be loaded for this file. */
    reader: "The reader of print files could not be loaded, so {name} is not open. Reload the page, and open the file again.",
    /** Shown if this browser did not keep the work on a model. */
    notKept: "{name} was not kept for the next visit: this browser has no room for it, or does not allow it.",
    reload: "Reload",
    close: "Close",
  },
});

export type PageWords = ReturnType<typeof pageWords>;
