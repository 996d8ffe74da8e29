/** The element without its registration, for pages that register it under their own name. */
export { CuspSlicer } from "./cusp-slicer.js";
export type { ModelOnPlate, State } from "./slicer-element.js";
export type { ChangeDetail, CuspSlicerEvents, ProgressDetail } from "./events.js";
export { PANELS, type Panel } from "./state/panel-names.js";
export { LANGUAGES, type LanguageCode } from "../texts/index.js";
