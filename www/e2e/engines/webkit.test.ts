/** The main paths in WebKitGTK. */
import { WEBKIT } from "./webkit.js";
import { paths } from "./paths.js";

paths(WEBKIT);
