/** The tools of the 3-D view and their texts, fetched with it. */
export { placementFields, placementMenu, placementStyles, steppedInMenu, type Placement } from "./placement-fields.js";
export { barStyles, viewBar } from "./view-bar.js";
export { viewTexts } from "../parts/view-texts.js";
