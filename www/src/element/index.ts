/** The element without its name: for pages that register it under one of their own. */
export { CuspSlicer, type State } from "./cusp-slicer.js";
export type { ChangeDetail, CuspSlicerEvents, ProgressDetail } from "./events.js";
export { PANELS, type Panel } from "./state/panel-names.js";
export { LANGUAGES, type LanguageCode } from "../texts/index.js";
