/** Apart from the keys, since the page asks this before it has the view. */
import type { Tool } from "./keys.js";

/** Returns true if the tool places points. */
export const places = (tool: Tool): boolean => tool === "supports" || tool === "drains";
