/** Texts for placing support points and drain holes, fetched with their panel. */
import { room } from "./messages.js";

export const placingTexts = room("placing", {
  points: {
    title: "Support points",
    /** Instructions in one sentence. */
    hint: "Click on the model to add a point; drag one to move it.",
    /** Label of the number that no support reaches, or that meet no void. */
    unreached: "Unreached",
    /** Number and height of the selected one. */
    selected: "Point {number} of {all}, at {height}",
    /** Replaces `selected` if none is. */
    none: "No point selected",
    /** Explains the lock. */
    lockHint: "A locked point stays when points are placed automatically.",
  },
  drains: {
    title: "Drain holes",
    hint: "Click on the model to add a hole; drag one to move it.",
    unreached: "Outside the void",
    selected: "Hole {number} of {all}, at {height}",
    none: "No hole selected",
    lockHint: "A locked hole stays when holes are placed automatically.",
  },
  /** Label of the number placed automatically. */
  automatic: "Automatic",
  /** Label of the number placed by hand, which stay. */
  byHand: "By hand",
  diameter: "Diameter (mm)",
  /** Diameter of new holes. */
  newDiameter: "Diameter of new holes (mm)",
  lock: "Locked",
  remove: "Delete",
  /** Label of the switch by which automatic supports and drain holes avoid large painted weights. */
  protect: "Keep points and holes off what is painted as important",
  /** Explains that it applies to both, and needs painted weights. */
  protectHint: "For points and holes alike. Paint important areas first.",
  /** Label of the button that saves plugs for the holes. */
  plugs: "Download plugs (STL)",
  /** Explains the use of plugs. */
  plugsHint: "Pins that close the holes: print them, and glue them in with resin.",
  automatically: "Place automatically",
  clear: "Clear",
});

export type PlacingTexts = ReturnType<typeof placingTexts>;
