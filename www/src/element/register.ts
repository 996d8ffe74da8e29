/** Makes `<cusp-slicer>` known to the browser. */
import { CuspSlicer } from "./cusp-slicer.js";
import { define } from "./define.js";

define("cusp-slicer", CuspSlicer);
