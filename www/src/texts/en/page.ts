/** The page around a model: opening it, facts about it, and the progress of tasks. */

export const page = () => ({
  page: {
    title: "Cusp: adaptive layers for resin printing",
    tagline: "Thin layers where the surface needs them, thick ones where it does not.",
    private: "Your model never leaves this computer.",
    drop: "Drop to open",
    languages: "Language",
    noModel: "No model at hand?",
    tryExample: "Try the example",
    printFile: "Look into a print file",
    example: "Example",
    points: [
      ["Fewest layers", "Every plan that keeps your tolerance is considered, and the shortest is taken."],
      ["No step too high", "The tolerance holds in each layer, not on average."],
      ["A file to print", "For printers by name, or as images of the layers with their thickness, in a zip."],
    ] as [string, string][],
  },
  open: {
    region: "Open a model",
    drop: "Drop an STL here",
    choose: "Choose a file",
    another: "Open another",
    opening: (name: string) => `Opening ${name}`,
    place: (place: string, total: string) => `Model ${place} of ${total}`,
    previous: "Previous model",
    next: "Next model",
  },
  model: {
    region: "The model",
    size: "Size",
    sizeHelp: "width × depth × height",
    scaled: (from: string) => `scaled from ${from}`,
    facets: "Facets",
    surface: "Surface",
    closed: "Watertight",
    open: "Not watertight",
  },
  progress: {
    load: "Reading the model",
    saliency: "Finding what stands out",
    ldi: "Casting rays through it",
    profile: "Measuring the surface",
    plan: "Planning the layers",
    masks: "Drawing the masks",
    orientation: "Measuring directions",
    left: (seconds: string) => `about ${seconds} left`,
    cancel: "Cancel",
  },
  notices: {
    cancelled: "Cancelled.",
    exportCancelled: "The download was cancelled.",
    partFailed: "This part of the page could not be loaded. Check your connection and try again; if that does not help, reload the page.",
    close: "Close",
  },
});

export type PageTexts = ReturnType<typeof page>;
