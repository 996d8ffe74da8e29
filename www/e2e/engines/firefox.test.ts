/** The main paths in Firefox. */
import { FIREFOX } from "./firefox.js";
import { paths } from "./paths.js";

paths(FIREFOX);
