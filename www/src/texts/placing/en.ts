import type { PlacingTexts } from "./index.js";

export const placing: PlacingTexts = {
  points: {
    title: "Support points",
    hint: "Click on the model to add a point; drag one to move it.",
    unreached: "Unreached",
    selected: (number, all, height) => `Point ${number} of ${all}, at ${height}`,
    none: "No point selected",
    lockHint: "A locked point stays when points are placed automatically.",
  },
  drains: {
    title: "Drain holes",
    hint: "Click on the model to add a hole; drag one to move it.",
    unreached: "Outside the void",
    selected: (number, all, height) => `Hole ${number} of ${all}, at ${height}`,
    none: "No hole selected",
    lockHint: "A locked hole stays when holes are placed automatically.",
  },
  automatic: "Automatic",
  byHand: "By hand",
  diameter: "Diameter (mm)",
  newDiameter: "Diameter of new holes (mm)",
  lock: "Locked",
  remove: "Delete",
  protect: "Keep points and holes off what is painted as important",
  protectHint: "For points and holes alike. Paint with “What matters” first.",
  plugs: "Download plugs (STL)",
  plugsHint: "Pins that close the holes: print them, and glue them in with resin.",
  automatically: "Place automatically",
  clear: "Clear",
};
