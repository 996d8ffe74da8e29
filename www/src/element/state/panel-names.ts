/** The parts that an element can show. */

/** What `panels` may name, in the order in which they stand. */
export const PANELS = ["open", "model", "settings", "plan", "view", "profile", "orientation", "quality", "layers"] as const;

export type Panel = (typeof PANELS)[number];
