/** Places of the workbench's panels: next to the view if there is room, otherwise on sheets over it. */
import type { Tool } from "../view/scene/keys.js";

/** Steps from a model to its print file, in the usual order; each can be skipped and repeated. */
export const STEPS = ["turn", "hollow", "support", "check", "slice"] as const;
/** Panels at the side of the result. */
export const ANSWERS = ["quality", "layers"] as const;
/** Panels other than steps that are sheets on a narrow screen, in the order of its bar. */
export const SHEETS = ["profile", "quality", "layers"] as const;

export type Step = (typeof STEPS)[number];
export type AnswerPanel = (typeof ANSWERS)[number];
/** Sheets of a narrow screen, including the result, which the figures in its bar open. */
export type Sheet = Step | (typeof SHEETS)[number] | "plan";

/** Tools of the view used in steps. */
export type HandTool = Extract<Tool, "rotate" | "drains" | "supports">;

/** From this width on, both sides fit next to the view, which remains the widest. */
export const WIDE_PX = 1180;

export function isStep(sheet: Sheet | null): sheet is Step {
  return STEPS.some((step) => step === sheet);
}
