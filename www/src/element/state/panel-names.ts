/** Names accepted by `panels`, in the order of the page. */
export const PANELS = ["open", "model", "plate", "settings", "plan", "view", "profile", "orientation", "quality", "layers", "findings"] as const;

export type Panel = (typeof PANELS)[number];
