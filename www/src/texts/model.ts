/** A model: opening it, facts about it, and the progress of tasks. */

export const model = {
  open: {
    region: "Open a model",
    drop: "Drop a model here",
    choose: "Choose a file",
    another: "Open another",
    opening: "Opening {name}",
    place: "Model {place} of {total}",
    previous: "Previous model",
    next: "Next model",
  },
  model: {
    region: "The model",
    size: "Size",
    sizeHelp: "width × depth × height",
    inFile: "{size} in the file",
    facets: "Facets",
    surface: "Surface",
    closed: "Watertight",
    open: "Not watertight",
  },
  progress: {
    load: "Reading the model",
    saliency: "Finding what stands out",
    ldi: "Scanning its shape",
    profile: "Measuring the surface",
    plan: "Planning the layers",
    masks: "Drawing the layers",
    inspect: "Looking for what will fail",
    orientation: "Measuring directions",
    left: "about {seconds} left",
    cancel: "Cancel",
  },
  notices: {
    cancelled: "Cancelled.",
    exportCancelled: "The download was cancelled.",
    partFailed: "This part of the page could not be loaded. Check your connection and try again; if that does not help, reload the page.",
    close: "Close",
  },
} as const;
