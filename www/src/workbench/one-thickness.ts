/** Uniform layers in the place of adaptive ones, for printers and files that take one thickness for all layers. */
import { uniformOf } from "../element/state/offers.js";
import type { Session } from "../element/state/session.js";
import type { Settings } from "../element/state/settings.js";

/** A plan that gave way to uniform layers. */
export interface Replaced {
  /** The printer, or the name of the format, that takes one thickness. */
  readonly taker: string;
  /** Layers of the plan. */
  readonly layers: number;
  readonly of: Pick<Settings, "printer" | "format">;
}

/** The best uniform layers within tolerance, if the printer does not take those of the plan; null if it does, or if there are none. */
export function oneThickness({ result, settings: { printer, format }, fixed }: Pick<Session, "result" | "settings" | "fixed">): { change: Partial<Settings>; replaced: Replaced } | null {
  const warning = result?.report.warnings.find(({ code }) => code === "one-thickness");
  if (result === null || warning?.code !== "one-thickness" || fixed.has("planner") || fixed.has("uniform")) return null;
  const { taker, best } = warning.detail;
  if (best === null) return null;
  return { change: uniformOf(best), replaced: { taker, layers: result.report.layers, of: { printer, format } } };
}

/** Returns true if the plan was made for this printer and format. */
export const isOf = ({ of }: Replaced, { printer, format }: Settings): boolean => of.printer === printer && of.format === format;
