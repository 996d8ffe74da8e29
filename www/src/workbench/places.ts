/** Where the panels of the workbench are: beside the view where there is room, on sheets over it where there is none. */
import type { Tool } from "../view/scene/keys.js";

/** The steps from a model to its print file, in the order in which one begins; each can be left out, and taken again. */
export const STEPS = ["turn", "check", "hollow", "support", "slice"] as const;
/** Panels at the side of the result. */
export const ANSWERS = ["quality", "layers"] as const;
/** Panels beside the steps that are a sheet on a narrow screen, in the order of its bar. */
export const SHEETS = ["profile", "quality", "layers"] as const;

export type Step = (typeof STEPS)[number];
export type AnswerPanel = (typeof ANSWERS)[number];
/** The result is a sheet, too: its figures in the bar open it. */
export type Sheet = Step | (typeof SHEETS)[number] | "plan";

/** The tools of the view that go with a step. */
export type HandTool = Extract<Tool, "rotate" | "drains" | "supports">;

/** From this width on, both sides stand beside the view, and leave it more room than either has. */
export const WIDE_PX = 1180;

export function isStep(sheet: Sheet | null): sheet is Step {
  return STEPS.some((step) => step === sheet);
}

/** Returns true if a step is about an open model; the others only set what its plan will be. */
export function needsModel(step: Step): boolean {
  return step === "turn" || step === "check";
}
