import type { Format } from "../format.js";
import { orientation } from "./orientation.js";
import { model } from "./model.js";
import { offers } from "./offers.js";
import { plan } from "./plan.js";
import { plate } from "./plate.js";
import { settings } from "./settings.js";
import { view } from "./view.js";
import { warnings } from "./warnings.js";

export const units = { hours: "h", minutes: "min" };

/**
 * All English texts, except those fetched with their panel. The compiler requires the same keys of the other languages, part by part.
 * Numbers are passed as text formatted for the language, unless a plural depends on them.
 */
export const en = (format: Format) => ({
  ...model(),
  ...settings(),
  ...plan(format),
  ...plate(),
  ...view(format),
  ...orientation(format),
  offers: offers(format),
  warnings: warnings(format),
});
