/** Separate from the keys, since the page needs it before the view is loaded. */
import type { Tool } from "./keys.js";

/** Returns true if the tool places points. */
export const places = (tool: Tool): boolean => tool === "supports" || tool === "drains";
