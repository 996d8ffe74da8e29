/** Where the panels of the workbench are: beside the view where there is room, on sheets over it where there is none. */

/** Panels at the side where one chooses. */
export const CHOICES = ["settings", "orientation"] as const;
/** Panels at the side of the result. */
export const ANSWERS = ["quality", "layers", "findings"] as const;
/** Panels that are a sheet on a narrow screen, in the order of its bar. */
export const SHEETS = ["settings", "orientation", "profile", "quality", "layers", "findings"] as const;

export type ChoicePanel = (typeof CHOICES)[number];
export type AnswerPanel = (typeof ANSWERS)[number];
/** The result is a sheet, too: its figures in the bar open it. */
export type Sheet = (typeof SHEETS)[number] | "plan";

/** From this width on, both sides stand beside the view, and leave it more room than either has. */
export const WIDE_PX = 1180;
