/** Registers `<cusp-workbench>`. */
import { define } from "../element/define.js";
import { CuspWorkbench } from "./cusp-workbench.js";

define("cusp-workbench", CuspWorkbench);
