/** Registers `<cusp-slicer>`. */
import { CuspSlicer } from "./cusp-slicer.js";
import { define } from "./define.js";

define("cusp-slicer", CuspSlicer);
