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
 * Every text that a user sees or hears, but for those that are fetched with what they are about, in English. The compiler holds the other languages to the same keys, part by part.
 * Numbers are passed as text, already formatted for the language, except where a plural depends on them.
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
