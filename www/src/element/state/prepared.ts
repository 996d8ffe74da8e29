/** Settings with which a model prints without further work. */
import { isFilament } from "../../api/facts.js";
import type { Candidate } from "../../api/wire.js";
import { withPose } from "./orientation.js";
import type { Result } from "./result.js";
import type { Settings } from "./settings.js";

/** Models of more resin than this are hollowed, ml. */
const HOLLOW_ML = 30;

/** Strength of the first supports. */
export const STRENGTH = "medium";

/** Walls of hollowed models, mm. */
export const WALL = "2";

/** Returns true if the file of the planned model has supports, which its print keeps. */
export function isPreSupported({ supports }: Pick<Settings, "supports">, result: Result | null): boolean {
  return supports === "none" && result !== null && result.options.supports == null && result.own?.supported != null;
}

/**
 * The pose of a candidate, supports, and walls for a model that takes much resin. Supports and walls already chosen stay, and slicers of
 * filament printers make both themselves.
 */
export function prepared(settings: Settings, candidate: Candidate, resin_ml: number): Partial<Settings> {
  const pose = withPose(settings, candidate);
  if (isFilament(settings.format)) return pose;
  return {
    ...pose,
    ...(settings.supports === "none" && { supports: STRENGTH }),
    ...(settings.wall.trim() === "" && resin_ml > HOLLOW_ML && { wall: WALL }),
  };
}
