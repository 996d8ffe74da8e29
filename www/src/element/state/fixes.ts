/** Remedies for findings: a change of the settings, or another direction of the model. */
import type { Code } from "../../api/wire.js";
import { isFilament } from "../../api/facts.js";
import { STRENGTH, WALL } from "./prepared.js";
import type { Settings } from "./settings.js";

export interface Fix {
  /** Name of the remedy, which is also that of its text. */
  readonly name: "supports" | "stronger" | "raft" | "drain" | "hollow" | "orient";
  /** Change of the settings; null if the model is to be turned. */
  readonly change: Partial<Settings> | null;
}

const ORIENT: Fix = { name: "orient", change: null };
const SUPPORT: Fix = { name: "supports", change: { supports: STRENGTH } };

/** Returns true if a support at the place of a finding is a remedy, beside those that there are. */
export function canSupport(code: Code, { supports, format }: Settings): boolean {
  return supports !== "none" && !isFilament(format) && (code === "island" || code === "loose-body" || code === "overhang");
}

/** The next remedy for findings of a kind; null if only the model itself can be changed. */
export function fixOf(code: Code, { supports, raft, wall, drain, format }: Settings): Fix | null {
  // Slicers of filament printers make supports and voids themselves.
  if (isFilament(format)) return null;
  const isSolid = wall.trim() === "";
  switch (code) {
    case "island":
    case "loose-body":
    case "overhang":
      if (supports === "none") return SUPPORT;
      return supports === "heavy" ? ORIENT : { name: "stronger", change: { supports: supports === "light" ? "medium" : "heavy" } };
    case "small-contact":
      if (supports === "none") return SUPPORT;
      return raft === "off" ? { name: "raft", change: { raft: "on" } } : ORIENT;
    case "cup":
    case "trap":
      if (!isSolid && drain === "none") return { name: "drain", change: { drain: "auto" } };
      return code === "cup" ? ORIENT : null;
    case "peel-area":
      return isSolid ? { name: "hollow", change: { wall: WALL } } : ORIENT;
    case "peel-jump":
    case "low-gap":
    case "thin-roof":
    case "closed-gap":
      return ORIENT;
    default:
      return null;
  }
}
