/** Texts of parts that are fetched on request: named settings, recent work, the tour, the keys. */
import { room } from "../texts/messages.js";

export const visitWords = room("visit", {
  saved: {
    none: "Nothing saved yet.",
    /** Label of the field for a name. */
    name: "Save the current settings as",
    save: "Save",
    /** Replaces `save` if the name is in use. */
    replace: "Replace",
    rename: "Rename “{name}”",
    delete: "Delete “{name}”",
    /** Explains which settings are saved. */
    about: "Saved in this browser: all settings except a model’s height and rotation.",
    saved: "“{name}” saved.",
    deleted: "“{name}” deleted.",
    undo: "Undo",
    /** Shown if the browser keeps nothing. */
    failed: "This browser does not allow it: its storage is full or switched off.",
    copyLink: "Copy link to these settings",
    copied: "Link copied.",
    /** Label of a field with the link, if the browser does not permit copying. */
    copyByHand: "Copy this link",
    /** Saves the current settings as a file. */
    toFile: "Save as cusp.toml",
    /** Explains the file's purpose and its omissions. */
    aboutFile: "For the command line: cusp slice --config cusp.toml. Without the model’s height and rotation.",
    /** Shown when the file was saved. */
    inFile: "cusp.toml saved.",
  },
  recent: {
    keep: "Keep my work in this browser",
    /** Explains what is kept, where, and the effect of switching it off. */
    about: "The last {works} models or plates with their supports, holes, painting and settings, up to {bytes}. They stay on this device. Switching this off deletes them.",
    none: "What you open from now on appears here.",
    /** Name of several models. */
    more: "{name} and {others} more",
    delete: "Delete {name}",
    deleted: "{name} deleted.",
    allDeleted: "All work deleted from this browser.",
    /** Shown if another tab has deleted the work. */
    gone: "{name} is no longer there.",
  },
  tour: {
    region: "Short tour",
    steps: [
      ["Look at the model", "Drag to turn it. Slide through its layers: the colours show how thick they are."],
      ["Step by step", "Orient, hollow, support and check: take the steps that you need, in any order. In the last one you choose printer, resin and layers."],
      ["Take the file", "Here are the print time, the resin and the file for your printer. Your work is kept in this browser: see Recent work."],
    ],
    place: "{step} of {steps}",
    next: "Next",
    skip: "Skip",
    done: "Done",
  },
  keys: {
    title: "Keys",
    close: "Close",
    everywhere: "Everywhere",
    /** Heading of the keys for placing support points and drain holes. */
    points: "Support points and drain holes",
    /** Heading of the keys for the layer slider and the chart. */
    layers: "Layer slider and chart",
    mask: "Mask, enlarged",
    directions: "Sphere of directions",
    does: {
      keys: "Show this list",
      open: "Open a file",
      paste: "Open a copied file",
      undo: "Undo",
      redo: "Redo",
      cancel: "Cancel or close",
      turnView: "Turn the view",
      zoom: "Zoom",
      whole: "Show the whole model",
      pickLayer: "Select the layer in the middle",
      menu: "Menu of the selected model",
      duplicate: "Duplicate what is selected",
      removeCopies: "Remove what is selected",
      sizeModel: "Scale the model by 1 %",
      sizeFar: "Scale the model by 10 %",
      moveCopy: "Move the copy by 1 mm",
      moveFar: "Move the copy by 10 mm",
      turnCopy: "Turn the copy by 15°",
      turnCopyFar: "Turn the copy by 45°",
      turnModel: "Turn the model by 5°",
      turnFinely: "Turn the model by 1°",
      lay: "Lay the face in the middle on the plate",
      paint: "Paint in the middle",
      undoStroke: "Undo a stroke",
      redoStroke: "Redo a stroke",
      nextPoint: "Next or previous",
      addPoint: "Add in the middle",
      removePoint: "Delete",
      lockPoint: "Lock or unlock",
      layer: "One layer down or up",
      layers: "Several layers",
      ends: "First or last layer",
      zoomChart: "Zoom the chart, or show all of it",
      move: "Move the picture",
      direction: "Next direction",
      use: "Use this direction",
    },
    names: { mod: "Ctrl", shift: "Shift", enter: "Enter", escape: "Esc", delete: "Delete", backspace: "Backspace", pageUp: "Page Up", pageDown: "Page Down", home: "Home", end: "End" },
    /** Label of the switch for `?`. */
    questionMark: "Open this list with ?",
    tour: "Show the tour",
  },
});
