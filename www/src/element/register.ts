/** Makes `<cusp-slicer>` known to the browser. */
import { CuspSlicer } from "./cusp-slicer.js";

if (customElements.get("cusp-slicer") === undefined) customElements.define("cusp-slicer", CuspSlicer);
